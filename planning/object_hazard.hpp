// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "core/landmark.hpp"
#include "geo/georeference.hpp"
#include "landmarks/landmark_type.hpp"
#include "planning/vehicle.hpp"
namespace waymark::planning {

/// Landmark that may stop a vehicle, as an upright cylinder.
struct HazardObject {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();    ///< metres, axes of the DEM
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< square metres
  double radius = 0, radius_sd = 0;                      ///< metres
  double probability = 1;                                ///< that it exists and is too high or too steep
};

/// Relative error of a feature that all its observations share: measured on a simulated landing
/// (docs/evaluation/2026-11-23-hazard-calibration.md).
inline constexpr double kCommonError = 0.14;
/// Relative sd of a feature of one observation.
inline constexpr double kUnknownSpread = 0.2;

/// Returns the landmark as an object; its probability is 0 if it is no hazard to the vehicle.
/// - Shadow casters: P(height > vehicle.obstacle_height()); without a height half the diameter.
/// - Bowls: P(4 depth / diameter > tan of the steepest slope), the slope of a paraboloid at its rim.
/// - Canopies and poles: the stem. Other types are no objects on the terrain.
/// The sd of a feature is its spread and `kCommonError` of its value, or `kUnknownSpread` without a spread.
HazardObject hazard_object(const Landmark& landmark, const LandmarkType& type, const Vehicle& vehicle);

/// Returns the distance from an object beyond which its probability counts as 0, metres.
double reach_of(const HazardObject& object, double base_radius);

/// Returns the probability that the base about a point touches the object. The disc of contact is taken as a
/// square along the line to the object.
double contact_probability(const HazardObject& object, const Eigen::Vector2d& point, double base_radius);

/// Returns the probability for each cell of a window that the base about it touches any of the objects.
/// Objects are combined in the given order.
Grid<float> object_hazard(std::span<const HazardObject> objects, const Window& window,
                          const Georeference& where, double base_radius);

}  // namespace waymark::planning

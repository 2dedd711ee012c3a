// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

// Standard deviations: 0 fixes the value, infinity leaves it free.

/// Surveyed point. A check point is reported, but never used.
struct ControlPoint {
  std::string name = {};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Constant(0.05);  ///< metres
  std::vector<Mark> marks = {};
  bool check = false;
};

/// Position of a camera, for example by GPS.
struct ObservedPosition {
  std::size_t image = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd = Eigen::Vector3d::Constant(1);  ///< metres
  bool biased_height = false;                         ///< z is too high by the unknown height bias
};

/// Attitude of a camera, for example of an inertial system.
struct ObservedAttitude {
  std::size_t image = 0;
  Eigen::Quaterniond world_from_camera = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sd = Eigen::Vector3d::Constant(0.01);  ///< radians, about the axes of the camera
};

/// Direction away from gravity, seen from the camera.
struct ObservedUp {
  std::size_t image = 0;
  Eigen::Vector3d up_in_camera = -Eigen::Vector3d::UnitY();
  double sd = 0.01;  ///< radians
};

/// Height of a camera, for example of an altimeter or above the take-off point.
struct ObservedHeight {
  std::size_t image = 0;
  double height = 0, sd = 1;  ///< metres
  bool biased = true;         ///< height is too large by the unknown height bias
};

/// Height of a camera above the ground straight below it, for example of an altimeter.
struct ObservedHeightAboveGround {
  std::size_t image = 0;
  double height = 0, sd = 1;  ///< metres
};

/// Known value of a lens parameter, named as in lens_model().
struct LensPrior {
  std::size_t lens = 0;
  std::string parameter = {};
  double value = 0, sd = 1;
};

/// Coarse DEM on which the tie points lie.
struct ObservedSurface {
  std::function<std::optional<double>(double x, double y)> height = {};  ///< `std::nullopt`: unknown
  double sd = 10;                                                        ///< metres
  double step = 1;                                                       ///< for its slope, metres
};

/// Observations besides the marks of tie points.
struct Observations {
  std::vector<ControlPoint> control = {};
  std::vector<ObservedPosition> positions = {};
  std::vector<ObservedAttitude> attitudes = {};
  std::vector<ObservedUp> ups = {};
  std::vector<ObservedHeight> heights = {};
  std::vector<ObservedHeightAboveGround> heights_above_ground = {};
  std::vector<LensPrior> lenses = {};
  std::optional<ObservedSurface> surface = {};
  double height_bias_sd = std::numeric_limits<double>::infinity();  ///< metres
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
namespace waymark::pipeline {

/// Relief without a frame: what is searched in a DEM.
struct ReliefToPlace {
  std::span<const Eigen::Vector3d> points = {};   ///< tie points
  std::span<const Eigen::Vector3d> centres = {};  ///< of the cameras: above the points
  std::optional<Eigen::Vector3d> up = {};         ///< direction away from gravity; none: normal of the points
};

/// Position of a relief in a DEM.
struct DemPlacement {
  Similarity map_from_frame = {};
  /// Of the shift (metres), the rotation about the map's axes through the middle of the points (radians), and
  /// the scale (as a fraction).
  Eigen::Matrix<double, 7, 7> covariance = Eigen::Matrix<double, 7, 7>::Zero();
  double residual = 0;            ///< of the points above the DEM, root mean square, metres
  double relief = 0;              ///< of the points about their plane, root mean square, metres
  double next_best_residual = 0;  ///< of the best other placement, for the same relief; infinity: none
};

struct DemPlacementResult {
  std::optional<DemPlacement> found = {};
  std::string message = {};  ///< why there is none
};

/// Limits of a placement that is accepted.
struct DemPlacementRules {
  double max_residual = 0.4;     ///< as a fraction of the relief
  double min_distinction = 1.5;  ///< residual of the next best placement, by that of the best
  double max_chance = 0.01;      ///< places expected to fit as well by chance
  double max_extents = 16;       ///< longer side of the DEM, by that of the points
  double smallest = 0;           ///< extent of the points in the DEM, metres
  double largest = std::numeric_limits<double>::infinity();
};

/// Finds seven parameters that bring a relief onto a DEM, without a start: shift, rotation, scale.
/// - Levels the points, then compares them with the DEM at all shifts, yaws of 5 degrees and scales of 6 %.
///   Each is taken about its own plane; the coefficient of agreement is 2 ab / (aa + bb).
/// - Refines the best by robust least squares of the vertical distances.
/// - Refuses reliefs that are flat against their residuals, so simple that chance explains the agreement, or
///   that fit another place nearly as well.
DemPlacementResult place_on_dem(const ReliefToPlace& relief, const CoarseHeights& dem,
                                const DemPlacementRules& rules = {});

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
namespace waymark::pipeline {

/// Similarity that keeps the vertical: plan by scale, yaw and shift, heights by the same scale and a lift.
struct LevelSimilarity {
  double log_scale = 0, yaw = 0;  ///< yaw: radians, counterclockwise
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double lift = 0;  ///< metres

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const;
};

/// Place of a level DEM in another one.
struct HeightRegistration {
  LevelSimilarity reference_from_map = {};
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< middle of the compared cells, in the reference
  /// Of x and y of the pivot (metres), the yaw about it (radians), the logarithm of the scale, and the height
  /// of the pivot (metres).
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();
  double residual = 0;            ///< of the heights, root mean square, metres
  double relief = 0;              ///< of the map about its plane, root mean square, metres of the reference
  double next_best_residual = 0;  ///< of the best other place; infinity: none
  std::size_t cells = 0;          ///< compared
};

struct HeightRegistrationResult {
  std::optional<HeightRegistration> found = {};
  std::string message = {};  ///< why there is none
};

struct HeightRules {
  double max_scale = 2;              ///< of the map, or its inverse; > 1
  DemPlacementRules placement = {};  ///< of the start; its sizes are those of the map by `max_scale`
};

/// Finds the place of a level DEM in a reference that contains it, without a start: `place_on_dem` on means
/// of both, then robust least squares (Cauchy) of all cells over five parameters. Both are averaged to the
/// coarser cell first, so that neither shows detail that the other lacks.
/// - The scale is adjusted by smoothed heights of the reference as instruments (Fuller 1987), since errors of
///   the compared heights would shrink it.
/// - The covariance weighs products of gradients by their distance (Conley 1999, Bartlett's window of twice
///   the correlation length of the residuals): errors that neighbours share count once. Errors common to the
///   whole map, such as a dome, are not in it.
HeightRegistrationResult register_heights(const CoarseHeights& map, const CoarseHeights& reference,
                                          const HeightRules& rules = {});

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>
#include "core/options.hpp"
#include "geo/terrain.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/terrain_pose.hpp"
namespace waymark::localization {

/// Returns whether the terrain leaves the line of sight from a sensor pose to a landmark free. Empty:
/// always free.
using LineOfSight = std::function<bool(const Pose2& sensor, const Eigen::Vector2d& landmark)>;

/// Options of a line-of-sight test on a DEM.
struct LineOfSightOptions {
  double sensor_height = 1;      ///< m above the ground
  double landmark_height = 0.3;  ///< m of a landmark above the ground that must be visible
  double step = 0.5;             ///< m between the samples of the terrain

  void describe(OptionVisitor& option);
};

/// Returns a line-of-sight test on the heights of a DEM; empty if `ground` is empty. Unknown terrain does
/// not occlude. Ignores curvature, so it holds for a few kilometres. A DEM of 1 m cells resolves hills that
/// hide landmarks, not rocks that do.
LineOfSight terrain_line_of_sight(TerrainHeight ground, const LineOfSightOptions& options);

/// Returns the same test on heights in memory, in the map frame. It is exact on the bilinear surface, costs
/// 1 us however long the line is, and is thread-safe.
/// - `body_radius` metres, 0 for a plane: the surface curves away below the line, less by `refraction`.
/// - Terrain within `options.step` or one cell of the landmark, whichever is more, does not hide it.
LineOfSight terrain_line_of_sight(const Terrain& terrain, const LineOfSightOptions& options,
                                  double body_radius, double refraction);

/// Returns whether the terrain hides a landmark for every position of the sensor within two standard
/// deviations: at the pose, and at the ends of both axes of the covariance of its position. False if
/// `visible` is empty.
bool is_hidden(const Pose2& sensor, const Eigen::Matrix2d& covariance, const Eigen::Vector2d& landmark,
               const LineOfSight& visible);

/// Ranges of a line scan by direction: what stands before a landmark hides it.
struct RangeProfile {
  double first_angle = 0, angle_step = 0;  ///< rad, left of the sensor's x axis
  std::vector<float> ranges;               ///< m; not above 0 or not finite: no return

  /// Returns whether all beams within `half_width` rad of a bearing, and the one nearest to it, reach `range`
  /// metres. Beams without a return reach any range. False where the scan does not cover the directions.
  bool reaches(double bearing, double half_width, double range) const;
};

/// Returns the landmarks within `range` metres of the sensor that it cannot see, ascending.
std::vector<std::uint32_t> hidden_landmarks(const Pose2& sensor, const LandmarkGrid& map, double range,
                                            const LineOfSight& visible);

}  // namespace waymark::localization

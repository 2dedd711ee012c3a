// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>
#include "core/options.hpp"
#include "localization/ground.hpp"
#include "localization/identification/landmark_grid.hpp"
namespace waymark {

/// Whether the ground lets a sensor at a pose see a landmark; none given: always.
using LineOfSight = std::function<bool(const Pose2& sensor, const Eigen::Vector2d& landmark)>;

struct SightOptions {
  double sensor_height = 1;      ///< m above the ground
  double landmark_height = 0.3;  ///< m above the ground that must be seen of a landmark
  double step = 0.5;             ///< m between the places where the ground is looked at

  void describe(OptionVisitor& option);
};

/// By the heights of a DEM. What the ground is not known of does not hide; curvature is left out, so for a
/// few kilometres. Heights of a DEM of 1 m cells are good to see hills hide landmarks, not to see rocks do.
/// Empty where `ground` is.
LineOfSight sight_over(GroundHeight ground, const SightOptions& options);

/// Landmarks within `range` metres of the sensor that it cannot see, ascending.
std::vector<std::uint32_t> hidden_landmarks(const Pose2& sensor, const LandmarkGrid& map, double range,
                                            const LineOfSight& visible);

}  // namespace waymark

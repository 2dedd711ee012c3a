// SPDX-License-Identifier: Apache-2.0
#include "localization/line_of_sight.hpp"

#include <algorithm>

namespace waymark::localization {

void LineOfSightOptions::describe(OptionVisitor& option) {
  option("sensor_height", sensor_height,
         {.help = "With --dem: height of the sensor above the ground, metres, for occlusion",
          .min = 0,
          .max = 100});
  option("landmark_height", landmark_height,
         {.help = "With --dem: height of a landmark that must be visible, metres", .min = 0, .max = 100});
  option("line_of_sight_step", step,
         {.help = "With --dem: metres between terrain samples along a line of sight",
          .min = 0.01,
          .max = 100,
          .formerly = "sight_step"});
}

LineOfSight terrain_line_of_sight(TerrainHeight ground, const LineOfSightOptions& options) {
  if (!ground) return {};
  return [ground = std::move(ground), options](const Pose2& sensor, const Eigen::Vector2d& landmark) {
    const auto from = ground(sensor.at()), to = ground(landmark);
    if (!from || !to) return true;
    const double distance = (landmark - sensor.at()).norm();
    const double eye = *from + options.sensor_height;
    const double rise = (*to + options.landmark_height - eye) / std::max(distance, 1e-9);
    // The last step belongs to the landmark: the ground below it does not hide it.
    for (double t = options.step; t < distance - options.step; t += options.step) {
      const auto height = ground(sensor.at() + (landmark - sensor.at()) * (t / distance));
      if (height && *height > eye + rise * t) return false;
    }
    return true;
  };
}

std::vector<std::uint32_t> hidden_landmarks(const Pose2& sensor, const LandmarkGrid& map, double range,
                                            const LineOfSight& visible) {
  std::vector<std::uint32_t> hidden;
  if (!visible) return hidden;
  map.near(sensor.at(), range, [&](std::uint32_t i) {
    if (!visible(sensor, map[i].at)) hidden.push_back(i);
  });
  std::ranges::sort(hidden);
  return hidden;
}

}  // namespace waymark::localization

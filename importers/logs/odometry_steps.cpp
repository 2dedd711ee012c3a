// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/odometry_steps.hpp"

#include <algorithm>
#include <iterator>

namespace waymark::importers {

void add_odometry_steps(localization::RobotLog& log, std::vector<localization::StampedPose> poses) {
  std::ranges::stable_sort(poses, {}, &localization::StampedPose::t);
  std::vector<localization::LogEvent> events;
  for (std::size_t i = 1; i < poses.size(); ++i)
    events.push_back({poses[i].t, localization::StepReading{inverse(poses[i - 1].pose) * poses[i].pose}});
  std::ranges::move(log.events, std::back_inserter(events));
  log.events = std::move(events);
  std::ranges::stable_sort(log.events, {}, &localization::LogEvent::t);
}

}  // namespace waymark::importers

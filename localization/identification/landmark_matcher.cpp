// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {

const LandmarkGrid& LandmarkMatcher::landmarks_near(const SightingSet& seen, const PoseEstimate& robot,
                                                    double view_range) {
  double farthest = view_range;
  for (const SeenLandmark& s : seen.sightings)
    if (s.is_valid())
      farthest = std::max(farthest, s.range ? *s.range + 6 * s.range_sd : options_.reach_of(s, scales_));
  const double width = std::sqrt(robot.covariance(0, 0) + robot.covariance(1, 1));
  const double mount = seen.robot_from_sensor.at().norm();
  return map_.landmarks_near(robot.pose.at(), farthest + 6 * width + mount + 1);
}

void LandmarkMatcher::set_clutter() {
  if (options_.learn_clutter)
    options_.clutter = std::max(min_clutter_, clutter_.density(options_.clutter_reach()));
}

void LandmarkMatcher::observe(const SightingSet& seen) {
  clutter_.add_sightings(seen);
  set_clutter();
}

void LandmarkMatcher::learn(std::span<const Match> matches) {
  double unmapped = 0, count = 0;
  for (const Match& m : matches) {
    if (m.verdict == Verdict::unsound || m.verdict == Verdict::unknown_type) continue;
    unmapped += m.unmapped;
    ++count;
  }
  clutter_.add_unmapped(unmapped, count);
  set_clutter();
}

}  // namespace waymark::localization

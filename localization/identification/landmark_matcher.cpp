// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kPastKept = 1 - 1.0 / 50;        // of the past, per set
constexpr double kMinRange = 1, kMinTurn = 0.35;  // m, rad: of a view
constexpr double kPrior = 1;                      // sightings of the map, and not of it, before any is known

}  // namespace

void ClutterEstimate::add_sightings(const SightingSet& seen) {
  for (double* sum : {&sets_, &sightings_, &ranged_, &squared_range_, &squared_bearing_}) *sum *= kPastKept;
  ++sets_;
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.is_valid()) continue;
    ++sightings_;
    squared_bearing_ += s.bearing * s.bearing;
    if (!s.range) continue;
    ++ranged_;
    squared_range_ += *s.range * *s.range;
  }
}

void ClutterEstimate::add_unmapped(double unmapped, double count) {
  unmapped_ = kPastKept * unmapped_ + unmapped;
  matched_ = kPastKept * matched_ + count - unmapped;
}

double ClutterEstimate::density(double bearing_reach) const {
  if (!(sightings_ > 0)) return 0;
  const double fraction = (unmapped_ + kPrior) / (unmapped_ + matched_ + 2 * kPrior);
  const double range = ranged_ > 0 ? std::sqrt(3 * squared_range_ / ranged_) : bearing_reach;
  const double turn = 2 * std::sqrt(3 * squared_bearing_ / sightings_);
  return fraction * sightings_ / sets_ / (std::max(range, kMinRange) * std::max(turn, kMinTurn));
}

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

// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::localization {
namespace {

constexpr double kMinRange = 1, kMinTurn = 0.35;  // m, rad: of a view
constexpr double kLongLine = 100;                 // m, half of a line of the map
constexpr double kPrior = 1;                      // sightings of the map, and not of it, before any is known

}  // namespace

void ClutterEstimate::add_sightings(const SightingSet& seen) {
  for (double* sum : {&sets_, &sightings_, &ranged_, &squared_range_, &directed_, &squared_bearing_})
    *sum *= kKept;
  ++sets_;
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.is_valid()) continue;
    ++sightings_;
    if (s.bearing) ++directed_, squared_bearing_ += *s.bearing * *s.bearing;
    if (!s.range) continue;
    ++ranged_;
    squared_range_ += *s.range * *s.range;
  }
}

void ClutterEstimate::add_unmapped(double unmapped, double count) {
  unmapped_ = kKept * unmapped_ + unmapped;
  matched_ = kKept * matched_ + count - unmapped;
}

double ClutterEstimate::density(double bearing_reach) const {
  if (!(sightings_ > 0)) return 0;
  const double fraction = (unmapped_ + kPrior) / (unmapped_ + matched_ + 2 * kPrior);
  const double range = ranged_ > 0 ? view_range() : bearing_reach;
  return fraction * sightings_ / sets_ /
         (std::max(range, kMinRange) * std::max(2 * view_bearing(), kMinTurn));
}

double ClutterEstimate::detection() const {
  return std::min(1.0, (matched_ + kPrior) / (in_view_ + kPrior));
}

double ClutterEstimate::view_range() const {
  return ranged_ > 0 ? std::sqrt(3 * squared_range_ / ranged_) : 0;
}

double ClutterEstimate::view_bearing() const {
  if (!(sightings_ > 0)) return 0;
  return directed_ > 0 ? std::sqrt(3 * squared_bearing_ / directed_) : std::numbers::pi;
}

const LandmarkGrid& LandmarkMatcher::landmarks_near(const SightingSet& seen, const PoseEstimate& robot,
                                                    double view_range) {
  double farthest = std::max(view_range, clutter_.view_range());
  for (const SeenLandmark& s : seen.sightings)
    if (s.is_valid() && s.extent)
      farthest = std::max(farthest, std::max(std::abs(s.extent->from), std::abs(s.extent->to)) + kLongLine);
    else if (s.is_valid())
      farthest = std::max(farthest, s.range ? *s.range + 6 * s.range_sd : options_.reach_of(s, scales_));
  const double width = std::sqrt(robot.covariance(0, 0) + robot.covariance(1, 1));
  const double mount = seen.robot_from_sensor.at().norm();
  return map_.landmarks_near(robot.pose.at(), farthest + 6 * width + mount + 1);
}

void LandmarkMatcher::set_clutter() {
  if (options_.learn_clutter)
    options_.clutter =
        std::max(min_clutter_, clutter_.density(options_.clutter_reach()) / clutter_.detection());
}

void LandmarkMatcher::observe(const SightingSet& seen) {
  clutter_.add_sightings(seen);
  options_.doubt_factors = doubt_->factors();
  set_clutter();
}

// Only for sightings without identities: one with an identity does not compete with other landmarks.
double LandmarkMatcher::landmarks_in_view(const SightingSet& seen, const Pose2& robot,
                                          const LandmarkGrid& map) {
  for (const SeenLandmark& s : seen.sightings) {
    if (options_.use_identities && s.identity) return 0;
    any_type_ = any_type_ || s.may_be_anything();
    for (const TypeId type : types_of(s))
      if (std::ranges::find(seen_types_, type) == seen_types_.end()) seen_types_.push_back(type);
  }
  const Pose2 sensor = robot * seen.robot_from_sensor;
  double count = 0;
  map.near(sensor.at(), clutter_.view_range(), [&](std::uint32_t i) {
    if (!any_type_ && std::ranges::find(seen_types_, map[i].type) == seen_types_.end()) return;
    if (is_left_out(map[i], options_)) return;
    const Eigen::Vector2d to = map[i].at - sensor.at();
    const double bearing = wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw);
    if (std::abs(bearing) <= clutter_.view_bearing()) count += existence_prior(map[i], options_);
  });
  return count;
}

// Learns where a landmark that likely exists supports the pose: doubtful ones alone may be matched at a wrong
// one. Sightings with identities say which landmark they show, whatever its confidence.
void LandmarkMatcher::learn_doubt(std::span<const Match> matches, const SightingSet& seen,
                                  const PoseEstimate& robot, const LandmarkGrid& map) {
  if (!learns_doubt_) return;
  std::vector<LandmarkKey> shown;
  bool is_supported = false;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    if (options_.use_identities && seen.sightings[k].identity) return;
    const bool is_matched = matches[k].verdict == Verdict::matched;
    shown.push_back(is_matched ? map[matches[k].pairing.landmark].key : 0);
    is_supported = is_supported || (is_matched && !map[matches[k].pairing.landmark].is_doubtful());
  }
  if (!is_supported) return;
  doubt_->add(seen, shown, robot, map,
              {.range = clutter_.view_range(),
               .bearing = clutter_.view_bearing(),
               .detection = clutter_.detection(),
               .clutter = clutter_.density(options_.clutter_reach())});
}

void LandmarkMatcher::learn(std::span<const Match> matches, const SightingSet& seen,
                            const PoseEstimate& robot, const LandmarkGrid& map) {
  if (matches.size() != seen.sightings.size()) return;
  double unmapped = 0, count = 0;
  for (const Match& m : matches) {
    if (m.verdict == Verdict::unsound || m.verdict == Verdict::unknown_type) continue;
    unmapped += m.unmapped;
    ++count;
  }
  clutter_.add_unmapped(unmapped, count);
  clutter_.add_in_view(landmarks_in_view(seen, robot.pose, map));
  learn_doubt(matches, seen, robot, map);
  set_clutter();
}

}  // namespace waymark::localization

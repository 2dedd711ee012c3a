// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/explained_fraction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace waymark::localization {
namespace {

constexpr double kFade = 1.0 / 40;  // per set: some 10 s of a scanner

}  // namespace

bool was_compared(const Match& match) {
  return match.verdict == Verdict::matched || match.verdict == Verdict::nothing_near ||
         match.verdict == Verdict::features_differ || match.verdict == Verdict::too_far;
}

double matched_fraction(const std::vector<Match>& matches) {
  int fits = 0, compared = 0;
  for (const Match& match : matches) {
    fits += match.verdict == Verdict::matched;
    compared += was_compared(match);
  }
  return compared > 0 ? static_cast<double>(fits) / compared : -1;
}

ChanceFraction make_chance_fraction(LandmarkMatcher matcher) {
  const auto calls = std::make_shared<int>(0);
  matcher.leave_doubt_to_copies();  // the filter learns from the same sets
  return [calls, matcher = std::make_shared<LandmarkMatcher>(std::move(matcher))](
             const SightingSet& seen, const PoseEstimate& at, std::span<const Match> matches) {
    matcher->observe(seen);
    matcher->learn(matches, seen, at, matcher->landmarks_near(seen, at));
    double reach = 0;
    for (const SeenLandmark& s : seen.sightings)
      if (s.is_valid() && s.range) reach = std::max(reach, *s.range + 6 * s.range_sd);
    if (!(reach > 0)) return -1.0;
    const double golden = 2.39996 * ++*calls, part = 0.5 + 0.5 * std::fmod(0.618034 * *calls, 1.0);
    PoseEstimate there = at;
    there.pose.x += part * reach * std::cos(golden);
    there.pose.y += part * reach * std::sin(golden);
    there.pose.yaw = wrap_angle(there.pose.yaw + 1 + 4 * part);
    const double width = std::sqrt(at.covariance(0, 0) + at.covariance(1, 1));
    return matched_fraction(
        matcher->identify(seen, there, matcher->landmarks_near(there.pose.at(), reach + 6 * width + 1))
            .matches);
  };
}

void ExplainedFraction::add(double fit, double chance) {
  if (fit < 0 || chance < 0) return;
  ++sets_;
  const double fade = std::max(kFade, 1.0 / sets_);
  fit_ += fade * (fit - fit_);
  chance_ += fade * (chance - chance_);
}

}  // namespace waymark::localization

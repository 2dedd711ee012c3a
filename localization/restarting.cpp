// SPDX-License-Identifier: Apache-2.0
#include "localization/restarting.hpp"

#include <cmath>

namespace waymark {
namespace {

constexpr int kWait = 5;
constexpr double kFade = 0.1;  // of the fit, per set

}  // namespace

Restarting::Restarting(const PoseEstimate& start, Begin begin, PoseFinder finder)
    : begin_(std::move(begin)), finder_(std::move(finder)), inner_(begin_(start)) {}

void Restarting::move(const BodyMotion& motion) {
  inner_->move(motion);
  memory_.move(motion);
}

std::vector<Match> Restarting::see(const SightingSet& seen) {
  memory_.add(seen);
  std::vector<Match> matches = inner_->see(seen);
  int fits = 0, strange = 0;
  for (const Match& match : matches) {
    fits += match.verdict == Verdict::matched;
    strange += match.verdict == Verdict::nothing_near || match.verdict == Verdict::features_differ ||
               match.verdict == Verdict::too_far;
  }
  if (fits + strange > 0) fit_ += kFade * (static_cast<double>(fits) / (fits + strange) - fit_);
  if (trust() != Trust::lost || seen.sightings.empty() || ++waited_ < kWait) return matches;
  waited_ = 0;
  FoundPoses found = finder_(with_bearings(memory_.recall(), seen));
  if (!found.sure) return matches;
  // The finder does not know how odometry blurred what is remembered as one: be careful.
  found.sure->covariance *= 4;
  inner_ = begin_(*found.sure);
  ++restarts_;
  fit_ = 1;
  return inner_->see(seen);
}

}  // namespace waymark

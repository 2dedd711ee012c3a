// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/detection_rates.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kPrior = 1;          // views, as many seen as missed, of a type at a range
constexpr double kConcentration = 1;  // views: how much landmarks of one type differ

std::size_t range_bin(double range) {
  const double half_octaves = 2 * std::log2(std::max(range, 1.0));
  return std::min(static_cast<std::size_t>(half_octaves), RangeViews::kBins - 1);
}

}  // namespace

void RangeViews::add(double range, bool is_seen) {
  Counts& counts = (last_seen ? after_seen : after_missed)[range_bin(range)];
  ++(is_seen ? counts.seen : counts.missed);
  last_seen = is_seen;
}

RangeViews& RangeViews::operator+=(const RangeViews& other) {
  const auto add = [](std::array<Counts, kBins>& to, const std::array<Counts, kBins>& from) {
    for (std::size_t b = 0; b < kBins; ++b) to[b].seen += from[b].seen, to[b].missed += from[b].missed;
  };
  add(after_missed, other.after_missed);
  add(after_seen, other.after_seen);
  return *this;
}

DetectionRates::OfType& DetectionRates::of(std::optional<TypeId> type) {
  if (types_.size() <= index(type)) types_.resize(index(type) + 1);
  return types_[index(type)];
}

void DetectionRates::note(std::optional<TypeId> type, double range) {
  of(type).reach = std::max(of(type).reach, range);
}

double DetectionRates::reach(std::optional<TypeId> type) const {
  const double any = types_.empty() ? 0 : types_[0].reach;
  if (!type) {
    double farthest = any;
    for (const OfType& t : types_) farthest = std::max(farthest, t.reach);
    return farthest;
  }
  return index(type) < types_.size() ? std::max(any, types_[index(type)].reach) : any;
}

void DetectionRates::learn(std::optional<TypeId> type, const RangeViews& views) {
  of(type).views += views;
}

double DetectionRates::log_miss(std::optional<TypeId> type, double range, const RangeViews& views) const {
  const std::size_t bin = range_bin(range);
  const auto counts = [&](const RangeViews& of) {
    return (views.last_seen ? of.after_seen : of.after_missed)[bin];
  };
  const RangeViews::Counts all = index(type) < types_.size() ? counts(types_[index(type)].views)
                                                             : RangeViews::Counts{},
                           own = counts(views);
  const double mean = (kPrior + all.missed) / (2 * kPrior + all.seen + all.missed);
  return std::log((kConcentration * mean + own.missed) / (kConcentration + own.seen + own.missed));
}

}  // namespace waymark::localization

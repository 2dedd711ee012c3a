// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/missed_views.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

constexpr double kViewLength = 0.5;  // of the range: another view begins
constexpr int kLooks = 3;            // from which a view that is not over counts as missed
constexpr double kMinLooks = 20;     // of a bin whose rate is known

// Returns the expected probability of what happened `yes` times and did not `no` times.
double jeffreys(double yes, double no) {
  return (yes + 0.5) / (yes + no + 1);
}

}  // namespace

MissedViews::Key MissedViews::key_of(const Look& look) {
  return {look.source, look.type ? *look.type + 1 : 0,
          static_cast<int>(std::floor(2 * std::log2(std::max(look.range, 0.1))))};
}

std::size_t MissedViews::bin_of(const Look& look) {
  const auto [at, is_new] = index_.emplace(key_of(look), bins_.size());
  if (is_new) bins_.emplace_back();
  return at->second;
}

// Adds what a landmark says about its bin, or removes it.
void MissedViews::credit(const History& history, double sign) {
  Bin& bin = bins_[history.bin];
  bin.looks += sign * history.looks, bin.hits += sign * history.hits;
  if (history.hits > 0)
    bin.visible += sign, bin.views += sign * history.views, bin.missed += sign * history.missed;
  else if (history.missed > 0)
    bin.invisible += sign;
}

void MissedViews::count(View& view, History& history) {
  if (view.is_counted) return;
  view.is_counted = true;
  ++history.views;
  if (!view.is_seen) ++history.missed, ++history.missed_since_match;
}

// Returns the view that a look belongs to; ends the one before.
MissedViews::View& MissedViews::view_of(Landmark& landmark, const Look& look) {
  auto view = std::ranges::find(landmark.views, look.source, &View::source);
  if (view != landmark.views.end() && (look.sensor - view->from).norm() <= kViewLength * view->range)
    return *view;
  if (view == landmark.views.end())
    view = landmark.views.insert(view, View{.source = look.source});
  else
    count(*view, landmark.histories[view->history]);
  const std::size_t bin = bin_of(look);
  const auto known = std::ranges::find(landmark.histories, bin, &History::bin);
  *view = {.source = look.source,
           .history = static_cast<std::size_t>(known - landmark.histories.begin()),
           .from = look.sensor,
           .range = look.range};
  if (known == landmark.histories.end()) landmark.histories.push_back({.bin = bin});
  return *view;
}

void MissedViews::add(const Look& look) {
  Landmark& landmark = landmarks_[look.landmark];
  if (landmark.exists)
    for (const History& h : landmark.histories) credit(h, -1);
  View& view = view_of(landmark, look);
  History& history = landmark.histories[view.history];
  ++view.looks, ++history.looks;
  history.hits += look.is_seen;
  if (look.is_seen && !view.is_seen) {
    view.is_seen = true;
    if (view.is_counted)
      --history.missed, history.missed_since_match = std::max(0, history.missed_since_match - 1);
  }
  if (view.is_seen || view.looks >= kLooks) count(view, history);
  if (landmark.exists)
    for (const History& h : landmark.histories) credit(h, 1);
}

void MissedViews::note_match(std::size_t index) {
  Landmark& landmark = landmarks_[index];
  for (History& h : landmark.histories) {
    h.missed_since_match = 0;
    if (!landmark.exists) credit(h, 1);
  }
  landmark.exists = true;
}

double MissedViews::evidence(std::size_t landmark) const {
  double sum = 0;
  for (const History& h : landmarks_[landmark].histories) {
    if (h.missed_since_match == 0) continue;
    const Bin& bin = bins_[h.bin];
    const double w = jeffreys(bin.invisible, bin.visible), m = jeffreys(bin.missed, bin.views - bin.missed);
    sum += std::log(w + (1 - w) * std::pow(m, h.missed_since_match));
  }
  return sum;
}

double MissedViews::detection(const Look& look) const {
  const auto at = index_.find(key_of(look));
  if (at == index_.end()) return 0.5;
  const Bin& bin = bins_[at->second];
  return jeffreys(bin.hits, bin.looks - bin.hits);
}

double MissedViews::best_detection() const {
  double best = 0;
  for (const Bin& bin : bins_)
    if (bin.looks >= kMinLooks) best = std::max(best, jeffreys(bin.hits, bin.looks - bin.hits));
  return best > 0 ? best : 1;
}

void MissedViews::forget_views() {
  for (Landmark& landmark : landmarks_) {
    landmark.views.clear();
    for (History& h : landmark.histories) h.missed_since_match = 0;
  }
}

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/airborne_recall.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

struct Share {
  double recall, sd;
};

constexpr double kHeights[] = {0, 0.6, 0.7, 0.8, 0.9};  // lower bounds, relative to dominant height

// Conifers, mixed, broadleaves of the synthetic forests, by the crowns detected in them. Neighbouring rows
// were pooled where recall did not increase with height.
struct Kind {
  double crown_to_height;
  Share of[std::size(kHeights)];
};
// Deviations are relative to the recall and equal for all heights, so that 90 % of the intervals of 1.645
// standard errors hold the stems of simulated forests (docs/evaluation/2026-11-22-errors-of-inventories.md).
constexpr double kConifers = 0.41, kMixed = 0.78, kBroadleaves = 0.8;
constexpr Share share(double recall, double relative) {
  return {recall, recall * relative};
}
constexpr Kind kKinds[] = {{0.194,
                            {share(0.72, kConifers), share(0.72, kConifers), share(0.72, kConifers),
                             share(0.72, kConifers), share(0.72, kConifers)}},
                           {0.246,
                            {share(0.31, kMixed), share(0.31, kMixed), share(0.42, kMixed),
                             share(0.55, kMixed), share(0.67, kMixed)}},
                           {0.295,
                            {share(0.16, kBroadleaves), share(0.16, kBroadleaves), share(0.28, kBroadleaves),
                             share(0.44, kBroadleaves), share(0.66, kBroadleaves)}}};

}  // namespace

std::vector<RecallRow> airborne_recall(double dominant_height, double crown_to_height) {
  if (!(dominant_height > 0) || !std::isfinite(dominant_height) || !(crown_to_height > 0)) return {};
  const bool wide = crown_to_height > kKinds[1].crown_to_height;
  const Kind &a = kKinds[wide], &b = kKinds[wide + 1];
  const double t =
      std::clamp((crown_to_height - a.crown_to_height) / (b.crown_to_height - a.crown_to_height), 0.0, 1.0);
  std::vector<RecallRow> rows;
  for (std::size_t i = 0; i < std::size(kHeights); ++i)
    rows.push_back({kHeights[i] * dominant_height, std::lerp(a.of[i].recall, b.of[i].recall, t),
                    std::lerp(a.of[i].sd, b.of[i].sd, t)});
  return rows;
}

}  // namespace waymark::pipeline

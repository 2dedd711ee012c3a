// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "pipeline/forest/canopy_window.hpp"
namespace waymark {

/// What makes a local maximum of a canopy a treetop. A tree is a small mountain: it stands out by height,
/// isolation and prominence (pipeline/terrain), each limited so that only the neighbourhood counts.
struct TreetopRules {
  double min_height = 3;  ///< metres above ground
  /// No higher cell within isolation_base + isolation_slope x height, metres.
  double isolation_base = 1, isolation_slope = 0.03;
  /// No higher cell is reached within `reach` metres without descending so far, metres; 0: not asked.
  double prominence = 0.25;

  double isolation(double height) const { return isolation_base + isolation_slope * height; }
  friend bool operator==(const TreetopRules&, const TreetopRules&) = default;
};

inline constexpr double kProminenceReach = 12;  ///< metres
inline constexpr double kTallestTree = 150;     ///< metres; what is higher is no tree

/// Rules of a cell, so that they may depend on the type of forest there.
using RulesAt = std::function<const TreetopRules&(const CanopyCell&)>;

struct Treetop {
  CanopyCell cell;
  float height = 0;  ///< of the smoothed canopy, metres
  friend bool operator==(const Treetop&, const Treetop&) = default;
};

/// The treetops among the cells `owned` of a smoothed canopy, in row order. Heights are compared in the order
/// of pipeline/terrain/cell_order.hpp, so plateaus have one top. Exact, and the same for any window that
/// reaches treetop_reach() cells beyond `owned`. About 10 ns per cell, prominence included, on smooth
/// canopies. Departure from topographic prominence: paths farther than kProminenceReach from the top do not
/// count.
std::vector<Treetop> find_treetops(const CanopyWindow& smooth, const Window& owned, const RulesAt& rules);

/// Cells beyond `owned` that decide about tops of `rules`: across and down.
std::int64_t treetop_reach(const TreetopRules& rules, double cell);

}  // namespace waymark

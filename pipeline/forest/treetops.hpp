// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "pipeline/forest/canopy_window.hpp"
namespace waymark::pipeline {

/// Conditions for a local maximum of a canopy to be a treetop: height, isolation and prominence, as for
/// summits (pipeline/terrain), each limited to a neighbourhood.
struct TreetopRules {
  double min_height = 3;  ///< metres above ground
  /// No higher cell lies within isolation_base + isolation_slope x height, metres.
  double isolation_base = 1, isolation_slope = 0.03;
  /// Minimum descent, metres, before a higher cell is reached within kProminenceReach; 0: no condition.
  double prominence = 0.25;

  double isolation(double height) const { return isolation_base + isolation_slope * height; }
  friend bool operator==(const TreetopRules&, const TreetopRules&) = default;
};

inline constexpr double kProminenceReach = 12;  ///< metres
inline constexpr double kMaxTreeHeight = 150;   ///< metres; higher cells are no trees

/// Returns the rules of a cell; they may depend on the forest type there.
using RulesAt = std::function<const TreetopRules&(const CanopyCell&)>;

/// Local maximum of a canopy.
struct Treetop {
  CanopyCell cell;
  float height = 0;  ///< of the smoothed canopy, metres
  friend bool operator==(const Treetop&, const Treetop&) = default;
};

/// Returns the treetops among the cells `owned` of a smoothed canopy, in row order.
/// - Heights are compared in the order of pipeline/terrain/cell_order.hpp, so plateaus have one top.
/// - Exact, and the same for any window that reaches treetop_reach() cells beyond `owned`.
/// - About 10 ns per cell on smooth canopies, prominence included.
/// Departure from topographic prominence: paths farther than kProminenceReach from the top do not count.
std::vector<Treetop> find_treetops(const CanopyWindow& smooth, const Window& owned, const RulesAt& rules);

/// Returns the distance in cells beyond `owned` within which heights affect tops under `rules`, in both
/// directions.
std::int64_t treetop_reach(const TreetopRules& rules, double cell);

}  // namespace waymark::pipeline

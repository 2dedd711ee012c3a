// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/treetops.hpp"
namespace waymark {

/// How far a crown reaches from its top.
struct CrownRules {
  double floor = 2;           ///< lowest cell of a crown, metres above ground
  double floor_share = 0.3;   ///< and as a share of the tree's height
  double radius_base = 2.5;   ///< largest radius: radius_base + radius_slope x height, metres;
  double radius_slope = 0.4;  ///< it may exceed the height: crowns can be wider than tall
  double max_radius = 14;     ///< and never more than this, metres

  double radius(double height) const {
    const double r = radius_base + radius_slope * height;
    return r < max_radius ? r : max_radius;
  }
  friend bool operator==(const CrownRules&, const CrownRules&) = default;
};

/// The cells of a tree's crown: one connected piece without holes.
struct Crown {
  Treetop top;
  std::int64_t cells = 0;        ///< of its own; those it encloses without being theirs included
  std::vector<CanopyCell> ring;  ///< outline through cell corners, counter-clockwise on a north-up map;
                                 ///< corner (c, r) is the upper left one of cell (c, r)
};

/// Crowns of the trees whose tops are in `owned`, in the order of `tops`: the watershed of -heights with the
/// tops as markers. Each cell climbs by the steepest way to a local maximum; one that is no treetop passes
/// its cells on to where the ground rises again beyond its highest saddle. `tops` are all treetops in `owned`
/// and crown_reach() cells around; `smooth` reaches twice as far.
/// Departure from flooding with a queue (Meyer 1994): no way leads farther from the top than the largest
/// radius, so a crown depends on its neighbourhood alone and is the same in every tiling. O(cells).
std::vector<Crown> find_crowns(const CanopyWindow& smooth, const Window& owned,
                               const std::vector<Treetop>& tops, const CrownRules& rules);

/// Cells beyond a top that decide about its crown, treetops aside.
std::int64_t crown_reach(const CrownRules& rules, double cell);

/// The outline of a connected set of cells, holes filled; see Crown::ring. `inside(column, row)` tells which
/// cells of `box` belong to it. Also counts the cells enclosed. Empty for no cells.
struct Outline {
  std::vector<CanopyCell> ring;
  std::int64_t cells = 0;
};
Outline outline_of(const Grid<std::uint8_t>& inside, std::int64_t column, std::int64_t row);

}  // namespace waymark

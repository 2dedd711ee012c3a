// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/forest/treetops.hpp"
namespace waymark::pipeline {

/// Limits of a crown about its top.
struct CrownRules {
  double floor = 2;                  ///< minimum height of a cell, metres above ground
  double min_height_fraction = 0.3;  ///< and as a fraction of the tree height
  double radius_base = 2.5;          ///< maximum radius: radius_base + radius_slope x height, metres;
  double radius_slope = 0.4;         ///< may exceed the height: crowns can be wider than tall
  double max_radius = 14;            ///< upper limit of the radius, metres

  double radius(double height) const {
    const double r = radius_base + radius_slope * height;
    return r < max_radius ? r : max_radius;
  }
  friend bool operator==(const CrownRules&, const CrownRules&) = default;
};

/// Cells of a crown: one connected piece without holes.
struct Crown {
  Treetop top;
  std::int64_t cells = 0;        ///< number of cells, including enclosed ones
  std::vector<CanopyCell> ring;  ///< outline through cell corners, counter-clockwise on a north-up map;
                                 ///< corner (c, r) is the upper left one of cell (c, r)
};

/// Delineates the crowns of the trees whose tops are in `owned`, in the order of `tops`: the watershed of
/// -heights with the tops as markers. O(cells).
/// - Each cell follows the steepest ascent to a local maximum. A maximum that is no treetop is merged
///   across its highest saddle.
/// - `tops` are all treetops in `owned` and crown_reach() cells around; `smooth` reaches twice as far.
/// Departure from flooding with a queue (Meyer 1994): no path leads farther from the top than the maximum
/// radius. A crown depends on its neighbourhood alone and is the same in every tiling.
std::vector<Crown> find_crowns(const CanopyWindow& smooth, const Window& owned,
                               const std::vector<Treetop>& tops, const CrownRules& rules);

/// Returns the distance in cells within which heights affect a crown, treetops aside.
std::int64_t crown_reach(const CrownRules& rules, double cell);

/// Outline of a connected set of cells with holes filled; see Crown::ring. `cells` includes enclosed cells.
/// Empty for no cells.
struct Outline {
  std::vector<CanopyCell> ring;
  std::int64_t cells = 0;
};
/// Outlines a set of cells; inside(0, 0) is the cell (column, row) of the canopy.
Outline outline_of(const Grid<std::uint8_t>& inside, std::int64_t column, std::int64_t row);

}  // namespace waymark::pipeline

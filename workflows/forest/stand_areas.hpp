// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "workflows/forest/stand_batches.hpp"
namespace waymark::workflows {

/// Where the stands of an inventory come from.
struct StandSource {
  std::string file;   ///< layer of polygons in any CRS; empty: the whole map
  std::string layer;  ///< of a file that holds several
  double grid = 0;    ///< metres, side of square cells in place of stands; 0: none
};

struct StandAreas {
  std::vector<NamedStand> stands;
  std::vector<std::string> warnings;
  std::vector<std::string> failed;  ///< stands that are no area, left out
};

/// Reads or makes the stands of a map. The area of a whole map is its layer `survey`, else the hull of its
/// trees with a warning. Throws Error{input} if that hull has no area, Error{usage} for more than 100,000
/// cells.
StandAreas read_stand_areas(const StandSource& source, const geodb::MapStore& map, const TreeReader& trees);

}  // namespace waymark::workflows

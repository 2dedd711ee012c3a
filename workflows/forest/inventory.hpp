// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>
#include "core/options/memory_option.hpp"
#include "workflows/callbacks.hpp"
#include "workflows/forest/stand_result.hpp"
namespace waymark::workflows {

/// Returns the number of trees that the memory holds, 1 kB each.
inline std::int64_t trees_in_memory(const MemoryOption& memory) {
  return memory.megabytes * 1000;
}

/// A map of trees and how its stands are counted.
struct InventoryRequest {
  std::string map;                ///< map with trees
  std::string output = {};        ///< .csv, or .gpkg that may be the map itself; empty: no file is written
  std::string stands = {};        ///< layer of polygons in any CRS; empty: the whole map
  std::string stands_layer = {};  ///< of a file that holds several
  std::string aoi = {};        ///< polygons, each a stand, in place of `stands`; trees outside do not count
  double grid = 0;             ///< metres, side of square cells in place of stands; 0: none
  std::string allometry = {};  ///< table of stem diameters by species; empty: those of the map
  std::string volume = {};     ///< table of form factors by species; empty: 0.47 +- 0.04 for all
  std::string recall = {};     ///< table of detection rates by height; empty: all trees were detected
  std::int64_t max_trees =
      trees_in_memory(MemoryOption{});  ///< trees held in memory, 1 kB each; figures do not depend on it
  double class_width = 5;               ///< centimetres, of diameter classes
  std::string report = {};              ///< .html to write; empty: none
};

/// Figures by stand.
struct InventoryResult {
  std::vector<StandResult> stands;
  std::size_t trees = 0;  ///< counted, once per stand
  std::vector<std::string> warnings;
  std::vector<std::string> failed;  ///< stands that are no area, left out
};

/// Counts a map's trees by stand and writes table, layers and report. Throws Error{usage} for options out of
/// range or in conflict, Error{input} for a map without trees' type or a table without the species.
InventoryResult inventory(const InventoryRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/export_map.hpp"
#include "geodb/map_contents.hpp"
#include "geodb/map_store.hpp"
namespace waymark {

/// Some types of a map with their evidence, images and latest run, in a CRS of the same body: a map again.
struct MapSubset {
  MapContents contents;
  std::vector<ExportedLayer> layers;
  std::vector<std::string> warnings;  ///< what stayed behind
};
MapSubset map_subset(const MapStore& map, const std::vector<std::string>& types, const Crs& crs);

}  // namespace waymark

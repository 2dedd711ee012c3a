// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/vector/export_map.hpp"
#include "exporters/vector/subset_layers.hpp"
#include "geodb/map_contents.hpp"
#include "geodb/map_store.hpp"
namespace waymark::exporters {

/// Some landmarks of a map with their evidence, images and latest run, in a CRS of the same body; without
/// shape layers, which subset_layers() returns. Landmarks and accepted observations are parts, read from the
/// map when it is written: it must be open until then.
struct MapSubset {
  geodb::MapContents contents;
  std::vector<ExportedLayer> layers;
  std::vector<std::string> warnings;  ///< parts that were left out
};
MapSubset map_subset(const geodb::MapStore& map, const LandmarkChoice& chosen, const Crs& crs);

}  // namespace waymark::exporters

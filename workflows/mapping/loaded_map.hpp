// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark::workflows {

/// Contents of a map in memory.
struct LoadedMap {
  TypeRegistry types;
  Crs crs = Crs::local();
  std::vector<Landmark> landmarks;
  std::vector<Observation> evidence;  ///< accepted ones name their landmark
  std::vector<geodb::ImageRecord> images;
  std::vector<geodb::ShapeLayer> layers;
  std::vector<geodb::RunRecord> runs;  ///< oldest first
  bool has_elevations = false;         ///< elevation tiles, which are not read
};

/// Reads a map, about 2 kB per landmark. Throws Error{input} for a map with errors.
/// A landmark without observations, of a table or added by hand, gets one: itself, of the source
/// "map <file name>".
LoadedMap load_map(const std::filesystem::path& path);

/// Returns whether load_map() made an observation of a landmark that had none.
bool is_stand_in(const Observation& observation);

/// Removes the observations that load_map() added to landmarks that have no other.
void drop_stand_ins(LoadedMap& map);

}  // namespace waymark::workflows

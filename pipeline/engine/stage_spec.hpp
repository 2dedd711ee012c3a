// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/engine/port.hpp"
namespace waymark::pipeline {

/// How often a stage runs.
enum class Scope {
  map,    ///< once; reads the artifacts of all tiles and images
  tile,   ///< once per tile; reads artifacts of the same tile and of the map
  image,  ///< once per image; reads artifacts of the same image and of the map
};

/// Returns "map", "tile" or "image".
std::string to_string(Scope scope);

/// Declaration of a stage.
struct StageSpec {
  std::string name;     ///< used in jobs, files and messages: [a-z][a-z0-9_]*
  std::string summary;  ///< one readable line
  int version = 1;      ///< raised when the same input gives another result
  Scope scope = Scope::map;
  /// Kind of items (tile or image) that this map-scope stage lists, in an output of type std::vector<Tile> or
  /// std::vector<ImageItem>.
  /// A listing stage and the stages it reads run while planning, so they must be cheap.
  std::optional<Scope> lists = {};
  std::int64_t halo = 0;  ///< cells around its tile that a tile-scope stage reads
  std::vector<InputPort> inputs = {};
  std::vector<OutputPort> outputs = {};
  /// Landmark types that it finds; each gets a table in the map even if none is found.
  std::vector<std::string> finds = {};
};

}  // namespace waymark::pipeline

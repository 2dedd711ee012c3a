// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/engine/port.hpp"
namespace waymark {

/// How often a stage runs.
enum class Scope {
  map,   ///< once; reads the artifacts of all tiles
  tile,  ///< once per tile; reads artifacts of the same tile and of the map
};

/// "map" or "tile".
std::string to_string(Scope scope);

/// What a stage declares about itself.
struct StageSpec {
  std::string name;     ///< of jobs, files and messages: [a-z][a-z0-9_]*
  std::string summary;  ///< one line for people
  int version = 1;      ///< raise it when the same input gives another result
  Scope scope = Scope::map;
  /// Scope::tile: this map-scope stage decides the tiles, in an output of type std::vector<Tile>. It reads no
  /// artifact and is cheap, because it runs while planning.
  std::optional<Scope> lists = {};
  std::int64_t halo = 0;  ///< cells a tile-scope stage looks at beyond its tile
  std::vector<InputPort> inputs = {};
  std::vector<OutputPort> outputs = {};
};

}  // namespace waymark

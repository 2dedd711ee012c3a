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
  map,    ///< once; reads the artifacts of all tiles and images
  tile,   ///< once per tile; reads artifacts of the same tile and of the map
  image,  ///< once per image; reads artifacts of the same image and of the map
};

/// "map", "tile" or "image".
std::string to_string(Scope scope);

/// What a stage declares about itself.
struct StageSpec {
  std::string name;     ///< of jobs, files and messages: [a-z][a-z0-9_]*
  std::string summary;  ///< one line for people
  int version = 1;      ///< raise it when the same input gives another result
  Scope scope = Scope::map;
  /// Scope::tile or Scope::image: this map-scope stage decides the tiles (images), in an output of type
  /// std::vector<Tile> (std::vector<ImageItem>). It is cheap, because it runs while planning, and so do the
  /// stages it reads.
  std::optional<Scope> lists = {};
  std::int64_t halo = 0;  ///< cells a tile-scope stage looks at beyond its tile
  std::vector<InputPort> inputs = {};
  std::vector<OutputPort> outputs = {};
  /// Landmark types it finds: they get a table in the map though none of them may be there.
  std::vector<std::string> finds = {};
};

}  // namespace waymark

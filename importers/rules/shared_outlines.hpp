// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>
#include "geo/outline_shapes.hpp"
#include "importers/rules/map_element.hpp"
namespace waymark::importers {

/// Vertices and walls that several outlines have in common, as houses of a row. Vertices are the same if
/// their coordinates are, to the last bit. Memory is about 40 bytes per vertex.
class SharedOutlines {
 public:
  void add(const MapElement& element);
  /// Returns what of an element that was added is shared, for derive_shapes().
  std::vector<std::vector<SharedVertex>> of(const MapElement& element) const;

 private:
  std::unordered_map<std::uint64_t, std::uint8_t> vertices_, walls_;  // hash -> outlines, up to 2
};

}  // namespace waymark::importers

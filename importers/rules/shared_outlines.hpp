// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
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

/// Ends of lines that are vertices of other lines, as walls drawn piece by piece. Vertices are the same if
/// their coordinates are, to the last bit; equal lines count once. Memory is about 70 bytes per vertex.
class LineJoints {
 public:
  void add(const MapElement& element);
  /// Marks the ends of an element that was added. `next` is in the coordinates of the file.
  void mark(const MapElement& element, std::vector<std::vector<SharedVertex>>& into) const;

 private:
  struct Joint {
    std::array<Eigen::Vector2d, 2> neighbours;  // vertices beside the ends that meet here
    std::uint8_t ends = 0;                      // up to 3
    bool through = false;                       // vertex of a line, not its end
  };
  void add_end(const Eigen::Vector3d& end, const Eigen::Vector3d& neighbour);

  std::unordered_map<std::uint64_t, Joint> joints_;
};

}  // namespace waymark::importers

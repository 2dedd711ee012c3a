// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>
#include "geo/outline_shapes.hpp"
#include "importers/rules/map_element.hpp"
namespace waymark::importers {

/// Places where lines meet, as walls drawn piece by piece: ends at ends, ends at vertices of other lines, and
/// ends within pieces of other lines, as partitions drawn against a wall.
/// - Vertices are the same if their coordinates are, to the last bit; equal lines count once.
/// - Memory is about 100 bytes per vertex and 32 bytes per piece.
class LineJoints {
 public:
  /// Converts a position of the file to metres near the one given last as the first argument.
  using ToMetres = std::function<Eigen::Vector2d(const Eigen::Vector2d& near, const Eigen::Vector2d& at)>;

  void add(const MapElement& element);
  /// Finds the ends that touch a piece between its vertices, within 5 cm. Called once, after all elements.
  /// `margin` is at least 5 cm in units of the file.
  void find_touching_ends(const ToMetres& to_metres, double margin);
  /// Marks the vertices of an element that was added. Positions of neighbours are coordinates of the file.
  void mark(const MapElement& element, std::vector<std::vector<SharedVertex>>& into) const;

 private:
  struct Branch {
    Eigen::Vector2d neighbour;  // next vertex of a line that comes here
    bool owned = true;          // by a line with a vertex here, which gets the corner on the branch's left
  };
  struct Joint {
    std::array<Branch, 4> branches;
    std::uint8_t count = 0;  // of branches; more than 4: too many lines
    std::uint8_t ends = 0;   // up to 3
    bool through = false;    // of a line that goes on

    void add(const Branch& branch);
  };
  struct Piece {
    Eigen::Vector2d from, to;
  };

  std::unordered_map<std::uint64_t, Joint> joints_;
  std::vector<Eigen::Vector3d> ends_;
  std::vector<Piece> pieces_;
};

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>
namespace waymark::pipeline {

/// Object of a cell.
struct CellObject {
  std::uint32_t cell = 0, index = 0;
};

/// Joins groups of objects that cross the borders of cells. About 30 bytes per object in such a group.
class Seams {
 public:
  /// Joins objects, at least one, and the groups that they are in.
  void join(std::span<const CellObject> objects);

  /// Object and the first cell of its group.
  struct Member {
    std::uint32_t index = 0, home = 0;
  };
  /// Returns the joined objects of each cell by index, and forgets them.
  std::vector<std::vector<Member>> finish(std::uint32_t cells);

 private:
  std::uint32_t number(const CellObject& object);
  std::uint32_t root(std::uint32_t i);

  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  std::vector<CellObject> objects_;
  std::vector<std::uint32_t> parent_;
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/seams.hpp"

#include <algorithm>

namespace waymark::pipeline {

std::uint32_t Seams::number(const CellObject& object) {
  const auto [found, added] = numbers_.try_emplace(std::uint64_t{object.cell} << 32 | object.index,
                                                   static_cast<std::uint32_t>(objects_.size()));
  if (added) {
    objects_.push_back(object);
    parent_.push_back(found->second);
  }
  return found->second;
}

std::uint32_t Seams::root(std::uint32_t i) {
  while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
  return i;
}

// The root is the object of the first cell.
void Seams::join(std::span<const CellObject> objects) {
  std::uint32_t first = root(number(objects[0]));
  for (const CellObject& object : objects.subspan(1)) {
    std::uint32_t other = root(number(object));
    if (objects_[other].cell < objects_[first].cell) std::swap(first, other);
    parent_[other] = first;
  }
}

std::vector<std::vector<Seams::Member>> Seams::finish(std::uint32_t cells) {
  numbers_ = {};
  std::vector<std::vector<Member>> of_cell(cells);
  for (std::uint32_t i = 0; i < objects_.size(); ++i)
    of_cell.at(objects_[i].cell).push_back({objects_[i].index, objects_[root(i)].cell});
  for (auto& members : of_cell) std::ranges::sort(members, {}, &Member::index);
  objects_ = {}, parent_ = {};
  return of_cell;
}

}  // namespace waymark::pipeline

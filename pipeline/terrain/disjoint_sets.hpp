// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numeric>
#include <vector>
namespace waymark::pipeline {

/// Disjoint sets (union-find). The caller chooses the surviving root; here it is the highest summit of an
/// island.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Merges a set into another. Both arguments must be roots.
  void join(std::size_t sunk, std::size_t into) { parent_[sunk] = into; }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
namespace waymark::pipeline {

/// Indices of two items, first < second.
struct IndexPair {
  std::uint32_t first = 0, second = 0;
  friend auto operator<=>(const IndexPair&, const IndexPair&) = default;
};

/// Returns all pairs of points with distance <= the sum of their `reach` that satisfy `wanted`, ascending.
/// `reach` in metres, >= 0, one per point; `wanted` is called from many threads.
/// Hashed grids, one per power of two of the reach, keep a few points of long reach (a crater of 100 m) from
/// slowing the search for all others.
/// O(n + pairs) if reaches are not much larger than spacings; about 1 M points/s and thread.
std::vector<IndexPair> find_neighbour_pairs(std::span<const Eigen::Vector3d> points,
                                            std::span<const double> reach,
                                            const std::function<bool(std::uint32_t, std::uint32_t)>& wanted);

}  // namespace waymark::pipeline

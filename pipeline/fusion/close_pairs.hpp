// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
namespace waymark {

/// Indices of two items, first < second.
struct IndexPair {
  std::uint32_t first = 0, second = 0;
  friend auto operator<=>(const IndexPair&, const IndexPair&) = default;
};

/// All pairs of places that reach each other: distance <= reach of one + reach of the other, and `wanted`.
/// Ascending. `reach` >= 0, metres, one per place; `wanted` is asked from many threads.
/// A stack of hashed grids, one per power of two of the reach, so that a few far-reaching places (a crater of
/// 100 m, an image of 2 m per pixel) do not make all others look far: each place asks its own grid and the
/// coarser ones. O(n + pairs) where reaches are not much wider than spacings; about 1 M places/s and thread.
std::vector<IndexPair> close_pairs(std::span<const Eigen::Vector3d> places, std::span<const double> reach,
                                   const std::function<bool(std::uint32_t, std::uint32_t)>& wanted);

}  // namespace waymark

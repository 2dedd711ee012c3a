// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>
#include "pipeline/terrain/divide_tree.hpp"
namespace waymark::pipeline {

/// Reference level for the highest summit of a land mass, which has no saddle to higher terrain.
enum class BasePolicy {
  automatic,  ///< `sea` if the highest cell lies above 0, else `lowest`: on most of Mars 0 has no meaning
  sea,        ///< elevation 0: prominence = elevation
  lowest,     ///< the lowest cell of the data
  none,       ///< prominence unknown
};

/// A summit with its prominence.
struct Summit {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t cell = 0;
  double height = 0;
  double prominence = kUnknown;  ///< metres; NaN under BasePolicy::none without a saddle
  double prominence_low =
      kUnknown;  ///< certified lower bound: unknown terrain can raise the saddle only to the contact
  std::int64_t saddle = -1;  ///< cell of the key saddle; -1: none
  double saddle_height = kUnknown;
  std::int64_t parent = -1;  ///< cell of the highest summit beyond the key saddle (island parent); -1: none
  friend bool operator==(const Summit&, const Summit&) = default;
};

/// Joins the tiles and returns all summits with at least `min_prominence` metres (more than 0), in the order
/// of cell_order.hpp.
/// - Topographic prominence with 8-connectivity: height above the highest saddle on any path to higher
///   terrain.
/// - A summit is a plateau of equal height without a higher neighbour, represented by its first cell in row
///   order. Summits of unknown prominence are kept.
/// O(s log s) for s saddles in all tiles.
std::vector<Summit> join_divide_trees(std::span<const std::shared_ptr<const DivideTree>> tiles,
                                      double min_prominence, BasePolicy base = BasePolicy::automatic);

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>
#include "pipeline/terrain/divide_tree.hpp"
namespace waymark {

/// What the highest summit of a piece of land, which has no saddle to higher ground, is measured from.
enum class BasePolicy {
  automatic,  ///< `sea` where the highest cell lies above 0, else `lowest`: 0 means nothing on most of Mars
  sea,        ///< elevation 0: prominence = elevation
  lowest,     ///< the lowest cell of the data
  none,       ///< its prominence is not known
};

struct Summit {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t cell = 0;
  double height = 0;
  double prominence = kUnknown;  ///< metres; NaN under BasePolicy::none without a saddle
  double prominence_low =
      kUnknown;              ///< certified: hidden ground can only raise the saddle as far as it is touched
  std::int64_t saddle = -1;  ///< cell of the key saddle; -1: none
  double saddle_height = kUnknown;
  std::int64_t parent =
      -1;  ///< cell of the highest summit beyond the key saddle (island parent); -1: none kept
  friend bool operator==(const Summit&, const Summit&) = default;
};

/// All summits with at least `min_prominence` metres (more than 0), in the order of cell_order.hpp.
/// Topographic prominence with 8-connectivity: height above the highest saddle on any path to higher ground.
/// A summit is a plateau of equal height without a higher neighbour; its first cell in row order stands for
/// it. Summits of unknown prominence are kept. O(s log s) for s saddles in all tiles.
std::vector<Summit> join_divide_trees(std::span<const std::shared_ptr<const DivideTree>> tiles,
                                      double min_prominence, BasePolicy base = BasePolicy::automatic);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "geodb/geopackage/geometry_blob.hpp"
namespace waymark::geodb {

/// Returns the index of a position on the Hilbert curve that fills `extent`.
std::uint32_t hilbert_position(const Eigen::Vector2d& position, const Envelope& extent);

/// Range of the Hilbert curve, and the parts with positions in it.
struct HilbertRange {
  std::uint32_t first = 0, last = 0xffffffff;  ///< both inclusive
  std::vector<std::uint32_t> parts;            ///< ascending

  bool contains(std::uint32_t curve_position) const {
    return first <= curve_position && curve_position <= last;
  }
};

/// Calls `take` for each position of a part.
using PartPositions =
    std::function<void(std::size_t part, const std::function<void(const Eigen::Vector2d&)>& take)>;

/// Divides the curve into consecutive ranges of about `max_in_memory` positions each, so that parts are
/// sorted in curve order with few of them in memory. Visits all positions once. A single part gives one
/// range. A range exceeds `max_in_memory` if one bin (1/65536 of the curve) has more positions.
std::vector<HilbertRange> divide_hilbert_curve(std::size_t parts, const PartPositions& positions,
                                               const Envelope& extent, std::size_t max_in_memory);

}  // namespace waymark::geodb

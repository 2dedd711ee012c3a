// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "geodb/geometry_blob.hpp"
namespace waymark {

/// Where a place in `extent` lies along the Hilbert curve that fills it.
std::uint32_t along_curve(const Eigen::Vector2d& place, const Envelope& extent);

/// A piece of the curve, and the parts that have places on it.
struct CurveRange {
  std::uint32_t first = 0, last = 0xffffffff;  ///< both belong to it
  std::vector<std::uint32_t> parts;            ///< ascending

  bool holds(std::uint32_t along) const { return first <= along && along <= last; }
};

/// Calls the function it is given for each place of a part.
using PlacesOfPart =
    std::function<void(std::size_t part, const std::function<void(const Eigen::Vector2d&)>& take)>;

/// Pieces of the curve, one behind the other, each of about `at_once` places: what is in parts, which lie
/// anywhere, can so be put in the curve's order while few parts are in memory. Looks at all places once; one
/// part alone is one piece. A piece grows beyond `at_once` where a 65536th of the curve holds more.
std::vector<CurveRange> divide_curve(std::size_t parts, const PlacesOfPart& places, const Envelope& extent,
                                     std::size_t at_once);

}  // namespace waymark

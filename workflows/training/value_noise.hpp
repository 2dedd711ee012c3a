// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include "core/random.hpp"
namespace waymark::workflows {

/// Smooth noise of unit standard deviation (value noise on a lattice of side 1, cubic weights). Keeps the
/// nodes of a square from call to call: neighbours in a row of samples mostly lie in the same one.
class ValueNoise {
 public:
  explicit ValueNoise(std::uint64_t seed) : seed_(seed) {}
  double at(double x, double y) {
    const double fx = std::floor(x), fy = std::floor(y);
    if (!(fx == x_ && fy == y_)) {
      const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
      x_ = fx, y_ = fy;
      nodes_ = {node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)};
    }
    const auto fade = [](double t) { return t * t * (3 - 2 * t); };
    const double u = fade(x - fx), v = fade(y - fy);
    return 2.6 *
           ((1 - v) * ((1 - u) * nodes_[0] + u * nodes_[1]) + v * ((1 - u) * nodes_[2] + u * nodes_[3]));
  }

 private:
  double node(std::int64_t i, std::int64_t j) const {
    const auto bits = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(i) * 0x9e3779b1U + 77 +
                                                mix_bits(static_cast<std::uint64_t>(j) + 12345)));
    return static_cast<double>(bits >> 11) * 0x1p-53 - 0.5;
  }
  std::uint64_t seed_;
  double x_ = std::numeric_limits<double>::quiet_NaN(), y_ = 0;  // corner of the square
  std::array<double, 4> nodes_ = {};
};

}  // namespace waymark::workflows

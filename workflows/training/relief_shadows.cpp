// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/relief_shadows.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::workflows {
namespace {

// Returns the steps from a position to the border of its square.
double steps_within(double at, double speed, std::int64_t index, int bits) {
  const double from = static_cast<double>(index >> bits << bits) - 0.5;
  const double to = from + static_cast<double>(std::int64_t{1} << bits);
  return speed > 0 ? (to - at) / speed : speed < 0 ? (from - at) / speed : 1e9;
}

}  // namespace

ReliefShadows::ReliefShadows(const RockRelief& relief, double elevation, double angle)
    : relief_(relief),
      step_x_(std::cos(angle)),
      step_y_(std::sin(angle)),
      rise_(std::tan(elevation) / RockRelief::kSamples) {
  const std::int64_t w = relief.columns, h = relief.rows;
  for (const int bits : {4, 6, 8}) {
    Squares of{bits, ((w - 1) >> bits) + 1, {}};
    of.top.assign(static_cast<std::size_t>(of.columns * (((h - 1) >> bits) + 1)), -1e9F);
    for (std::int64_t v = 0; v < h; ++v)
      for (std::int64_t u = 0; u < w; ++u) {
        float& top = of.top[static_cast<std::size_t>((v >> bits) * of.columns + (u >> bits))];
        top = std::max(top, relief(u, v));
      }
    squares_.push_back(std::move(of));
  }
  highest_ = static_cast<double>(std::ranges::max(squares_.back().top));
}

bool ReliefShadows::is_shadowed(std::int64_t column, std::int64_t row) const {
  const double right = static_cast<double>(relief_.columns) - 0.5;
  const double bottom = static_cast<double>(relief_.rows) - 0.5;
  const double start = relief_(column, row) + 1e-4;
  for (double t = 1;;) {
    const double z = start + t * rise_;
    const double x = static_cast<double>(column) + t * step_x_, y = static_cast<double>(row) + t * step_y_;
    if (!(x > -0.5 && y > -0.5 && x < right && y < bottom) || z > highest_) return false;
    const auto u = static_cast<std::int64_t>(x + 0.5), v = static_cast<std::int64_t>(y + 0.5);
    int bits = 0;  // of the largest square that is below the ray
    for (const Squares& of : squares_) {
      const std::int64_t square = (v >> of.bits) * of.columns + (u >> of.bits);
      if (!(z > static_cast<double>(of.top[static_cast<std::size_t>(square)]))) break;
      bits = of.bits;
    }
    if (bits > 0) {  // steps of two samples; the last one within the square is looked at again
      const double steps =
          std::min(steps_within(x, step_x_, u, bits), steps_within(y, step_y_, v, bits)) - 0.01;
      t += steps > 4 ? 2 * static_cast<double>(static_cast<std::int64_t>(steps / 2)) : 2;
      continue;
    }
    if (static_cast<double>(relief_(u, v)) > z) return true;
    t += 1;
  }
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/bowl_depth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark::pipeline {
namespace {

constexpr int kAzimuths = 36;

// Returns the height at `fraction` of the semi-axes and phase t of the ellipse.
std::optional<double> height_at(const Terrain& terrain, const GroundOutline& o, double t, double fraction) {
  const double along = fraction * o.major / 2 * std::cos(t), across = fraction * o.minor / 2 * std::sin(t);
  const double s = std::sin(o.orientation), c = std::cos(o.orientation);
  return terrain.height(o.centre.x() + along * s + across * c, o.centre.y() + along * c - across * s);
}

double nth(std::vector<double>& values, std::size_t n) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

}  // namespace

std::optional<BowlDepth> bowl_depth(const Terrain& terrain, const GroundOutline& outline) {
  const double cell = std::max(terrain.step_x(), terrain.step_y());
  if (!(outline.minor >= 5 * cell)) return std::nullopt;
  std::vector<double> rim, floor;
  for (int k = 0; k < kAzimuths; ++k) {
    const double t = 2 * std::numbers::pi * k / kAzimuths;
    std::optional<double> crest;
    for (const double fraction : {0.9, 0.94, 0.98, 1.02, 1.06, 1.1}) {
      const auto h = height_at(terrain, outline, t, fraction);
      if (!h) return std::nullopt;
      crest = std::max(crest.value_or(*h), *h);
    }
    rim.push_back(*crest);
    for (const double fraction : {0.06, 0.16, 0.28, 0.4}) {
      const auto h = height_at(terrain, outline, t, fraction);
      if (!h) return std::nullopt;
      floor.push_back(*h);
    }
  }
  const double rim_height = nth(rim, rim.size() / 2);
  const double spread = (nth(rim, rim.size() * 84 / 100) - nth(rim, rim.size() * 16 / 100)) / 2;
  // Heights along a rim are correlated over about a sixth of its circumference.
  const double uneven = spread * 1.25 / std::sqrt(6.0);
  return BowlDepth{rim_height, rim_height - nth(floor, floor.size() / 10),
                   std::hypot(terrain.height_sd(), uneven)};
}

}  // namespace waymark::pipeline

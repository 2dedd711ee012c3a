// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/shadow_shape.hpp"

#include <algorithm>
#include <vector>
namespace waymark::pipeline {
namespace {

constexpr float kOtherShadow =
    0.5F;  // fraction of the peak above which a ring pixel belongs to another shadow
constexpr float kMeanOfClippedNoise = 0.4F;  // E max(0, n) of a unit normal is 1 / sqrt(2 pi)

enum Role : char { outside, ring, core };

// Roles of the pixels in and around a segment.
struct Stencil {
  std::int32_t x0 = 0, y0 = 0;
  Grid<char> role;
};

Stencil stencil_of(const ShadowMap& map, const ShadowSegment& segment) {
  const auto columns = static_cast<std::int32_t>(map.alpha.columns());
  std::int32_t x0 = columns, x1 = 0, y0 = static_cast<std::int32_t>(map.alpha.rows()), y1 = 0;
  for (const std::int32_t cell : segment.cells) {
    x0 = std::min(x0, cell % columns);
    x1 = std::max(x1, cell % columns);
    y0 = std::min(y0, cell / columns);
    y1 = std::max(y1, cell / columns);
  }
  Stencil stencil{x0 - 1, y0 - 1, Grid<char>(x1 - x0 + 3, y1 - y0 + 3, outside)};
  for (const std::int32_t cell : segment.cells)
    stencil.role(cell % columns - stencil.x0, cell / columns - stencil.y0) = core;
  for (std::int64_t y = 0; y < stencil.role.rows(); ++y)
    for (std::int64_t x = 0; x < stencil.role.columns(); ++x) {
      if (stencil.role(x, y) != core) continue;
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dx = -1; dx <= 1; ++dx)
          if (stencil.role(x + dx, y + dy) == outside) stencil.role(x + dx, y + dy) = ring;
    }
  return stencil;
}

}  // namespace

ShadowShape measure_shadow(const ShadowMap& map, const ShadowSegment& segment, const LightFrame& light) {
  const Stencil stencil = stencil_of(map, segment);
  ShadowShape shape;
  shape.peak = static_cast<double>((segment.peak - segment.base) / (1 - segment.base));
  const float max_dark = segment.base + kOtherShadow * (segment.peak - segment.base);
  double sum_x = 0, sum_y = 0, sum_tt = 0, sum_ss = 0, sum_st = 0;
  for (std::int64_t v = 0; v < stencil.role.rows(); ++v)
    for (std::int64_t u = 0; u < stencil.role.columns(); ++u) {
      const char role = stencil.role(u, v);
      if (role == outside) continue;
      const std::int64_t x = stencil.x0 + u, y = stencil.y0 + v;
      if (!map.alpha.contains(x, y)) {
        shape.cut = true;
        continue;
      }
      double weight = std::max(0.0F, (map.alpha(x, y) - segment.base) / (1 - segment.base));
      if (role == core) {
        ++shape.cells;
        weight = std::min(weight, 1.15);
      } else {
        if (map.smooth(x, y) > max_dark) continue;  // belongs to another shadow
        weight -= static_cast<double>(kMeanOfClippedNoise * map.noise);
      }
      // Relative to the darkest pixel, for precision far from the origin.
      const double dx = static_cast<double>(x - segment.x), dy = static_cast<double>(y - segment.y);
      const double t = light.along(dx, dy), s = light.across(dx, dy);
      shape.area += weight;
      sum_x += weight * dx;
      sum_y += weight * dy;
      sum_tt += weight * t * t;
      sum_ss += weight * s * s;
      sum_st += weight * s * t;
    }
  if (!(shape.area > 0)) return shape;
  const double dx = sum_x / shape.area, dy = sum_y / shape.area;
  const double t = light.along(dx, dy), s = light.across(dx, dy);
  shape.x = segment.x + dx;
  shape.y = segment.y + dy;
  shape.along_variance = std::max(0.0, sum_tt / shape.area - t * t);
  shape.across_variance = std::max(0.0, sum_ss / shape.area - s * s);
  shape.covariance = sum_st / shape.area - s * t;
  return shape;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/lit_terrain.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "testbed/landing/relief.hpp"

namespace waymark::testbed {
namespace {

// Height of the shadow surface at each node: the maximum over the terrain towards the sun, lowered by
// tan(elevation) per metre of distance. One pass away from the sun, by rows (or columns, whichever the light
// crosses); each node interpolates the previous line where its sun ray crosses it.
Grid<float> shadow_surface(const Grid<float>& heights, const NodeGrid& nodes, const Sun& sun) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  Grid<float> shadow(nodes.columns, nodes.rows, -1e30F);
  const double flat = light.head<2>().norm();
  if (flat < 1e-9) return shadow;
  const bool by_rows = std::abs(light.y()) >= std::abs(light.x());
  const std::int64_t lines = by_rows ? nodes.rows : nodes.columns,
                     along = by_rows ? nodes.columns : nodes.rows;
  // Row index grows southwards, so light from the north comes from smaller indices.
  const double towards_line = by_rows ? -light.y() : light.x(),
               towards_along = by_rows ? light.x() : -light.y();
  const std::int64_t step = towards_line > 0 ? 1 : -1;
  const double shift = towards_along / std::abs(towards_line);
  const double fall = light.z() / std::abs(towards_line) * nodes.step;
  const auto cell = [&](std::int64_t line, std::int64_t at) {
    return by_rows ? std::pair{at, line} : std::pair{line, at};
  };
  const std::int64_t first = step > 0 ? lines - 2 : 1;
  for (std::int64_t line = first; line >= 0 && line < lines; line -= step) {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, along, 512), [&](const auto& range) {
      for (std::int64_t at = range.begin(); at < range.end(); ++at) {
        const double from = double(at) + shift;
        if (from < 0 || from > double(along - 1)) continue;
        const auto a = std::min(static_cast<std::int64_t>(from), along - 2);
        const auto w = static_cast<float>(from - double(a));
        const auto [c0, r0] = cell(line + step, a);
        const auto [c1, r1] = cell(line + step, a + 1);
        const float ground = std::lerp(heights(c0, r0), heights(c1, r1), w);
        const float above = std::lerp(shadow(c0, r0), shadow(c1, r1), w);
        const auto [c, r] = cell(line, at);
        shadow(c, r) = static_cast<float>(double(std::max(ground, above)) - fall);
      }
    });
  }
  return shadow;
}

Eigen::Vector4f blended(const Grid<Eigen::Vector4f>& grid, double column, double row) {
  const double c = std::clamp(column, 0.0, double(grid.columns() - 1));
  const double r = std::clamp(row, 0.0, double(grid.rows() - 1));
  const auto i = std::min(static_cast<std::int64_t>(c), std::max<std::int64_t>(0, grid.columns() - 2));
  const auto j = std::min(static_cast<std::int64_t>(r), std::max<std::int64_t>(0, grid.rows() - 2));
  const std::int64_t i1 = std::min(i + 1, grid.columns() - 1), j1 = std::min(j + 1, grid.rows() - 1);
  const auto u = static_cast<float>(c - double(i)), v = static_cast<float>(r - double(j));
  return (1 - v) * ((1 - u) * grid(i, j) + u * grid(i1, j)) + v * ((1 - u) * grid(i, j1) + u * grid(i1, j1));
}

}  // namespace

LitTerrain::LitTerrain(const Scene& scene, const Sun& sun)
    : nodes_(nodes_of(scene.ground)), sun_(sun), middle_(scene.ground.east, scene.ground.north) {
  const Grid<float>& heights = scene.terrain.heights();
  shadow_ = shadow_surface(heights, nodes_, sun);
  soft_ = 0.35 * nodes_.step * std::tan(std::max(0.02, to_radians(sun.elevation).value));

  fine_ = relief_fractal(scene.ground.relief, 0, scene.seed);
  while (fine_.longest > 2 * nodes_.step) fine_.longest /= 2, fine_.amplitude *= std::exp2(-fine_.hurst);
  fine_.amplitude *= scene.ground.relief.roughness;
  fine_.seed = static_cast<std::uint32_t>(named_seed(scene.seed, "relief below the cells"));

  fine_fall_ = std::exp2(-fine_.hurst);

  Grid<Eigen::Vector4f> looks(nodes_.columns, nodes_.rows, Eigen::Vector4f::Zero());
  const auto step = static_cast<float>(nodes_.step);
  tbb::parallel_for(std::int64_t{0}, nodes_.rows, [&](std::int64_t j) {
    const std::int64_t up = std::max<std::int64_t>(j - 1, 0), down = std::min(j + 1, nodes_.rows - 1);
    for (std::int64_t i = 0; i < nodes_.columns; ++i) {
      const std::int64_t left = std::max<std::int64_t>(i - 1, 0), right = std::min(i + 1, nodes_.columns - 1);
      looks(i, j) = {(heights(right, j) - heights(left, j)) / (float(right - left) * step),
                     (heights(i, up) - heights(i, down)) / (float(down - up) * step), scene.albedo(i, j),
                     static_cast<float>(lit_fraction(nodes_.x(i), nodes_.y(j), double(heights(i, j))))};
    }
  });
  shading_levels_.push_back(std::move(looks));
  while (shading_levels_.back().columns() > 8 && shading_levels_.back().rows() > 8) {
    const auto& fine = shading_levels_.back();
    Grid<Eigen::Vector4f> coarse(fine.columns() / 2, fine.rows() / 2, Eigen::Vector4f::Zero());
    for (std::int64_t j = 0; j < coarse.rows(); ++j)
      for (std::int64_t i = 0; i < coarse.columns(); ++i)
        coarse(i, j) = 0.25F * (fine(2 * i, 2 * j) + fine(2 * i + 1, 2 * j) + fine(2 * i, 2 * j + 1) +
                                fine(2 * i + 1, 2 * j + 1));
    shading_levels_.push_back(std::move(coarse));
  }
}

double LitTerrain::shadow_height(double x, double y) const {
  const double column = std::clamp(nodes_.column(x), 0.0, double(nodes_.columns - 1));
  const double row = std::clamp(nodes_.row(y), 0.0, double(nodes_.rows - 1));
  const auto i = std::min(static_cast<std::int64_t>(column), nodes_.columns - 2);
  const auto j = std::min(static_cast<std::int64_t>(row), nodes_.rows - 2);
  const double u = column - double(i), v = row - double(j);
  return std::lerp(std::lerp(double(shadow_(i, j)), double(shadow_(i + 1, j)), u),
                   std::lerp(double(shadow_(i, j + 1)), double(shadow_(i + 1, j + 1)), u), v);
}

double LitTerrain::lit_fraction(double x, double y, double z) const {
  return std::clamp(0.5 + (z - shadow_height(x, y)) / (2 * soft_), 0.0, 1.0);
}

SurfaceShading LitTerrain::shading(const Eigen::Vector3d& point, double size) const {
  const double level =
      std::clamp(std::log2(std::max(size / nodes_.step, 1.0)), 0.0, double(shading_levels_.size() - 1));
  const auto l = static_cast<std::size_t>(level);
  // Cell i of level l is the mean of nodes i 2^l ... (i + 1) 2^l - 1.
  const auto sample = [&](std::size_t of) {
    const double cells = double(std::int64_t{1} << of);
    return blended(shading_levels_[of], (nodes_.column(point.x()) + 0.5) / cells - 0.5,
                   (nodes_.row(point.y()) + 0.5) / cells - 0.5);
  };
  Eigen::Vector4f look = sample(l);
  if (const auto part = static_cast<float>(level - double(l)); part > 0 && l + 1 < shading_levels_.size())
    look += part * (sample(l + 1) - look);
  SurfaceShading result{double(look.x()), double(look.y()), double(look.z()), double(look.w())};
  if (level < 1) {
    // Shadows are sharp nearby; relief finer than the cells fades out towards the Nyquist limit.
    result.lit = std::lerp(lit_fraction(point.x(), point.y(), point.z()), result.lit, level);
    double height = fine_.amplitude, length = fine_.longest;
    const double x = point.x() - middle_.x(), y = point.y() - middle_.y();
    for (std::uint32_t octave = 0; length > 1.5 * size && octave < 8; ++octave) {
      const double weight = std::clamp(length / size - 1.5, 0.0, 1.0) * height / length;
      const auto [c, s] = octave_turn(octave + 1);
      const NoiseValue n =
          gradient_noise((c * x - s * y) / length, (s * x + c * y) / length, fine_.seed + octave);
      result.slope_x += weight * (c * n.dx + s * n.dy);
      result.slope_y += weight * (c * n.dy - s * n.dx);
      height *= fine_fall_, length /= 2;
    }
  }
  return result;
}

}  // namespace waymark::testbed

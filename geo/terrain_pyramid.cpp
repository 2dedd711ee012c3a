// SPDX-License-Identifier: Apache-2.0
#include "geo/terrain_pyramid.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace waymark::inline geo {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kContactTolerance = 1e-6;  // metres, see terrain.cpp

// Returns the first t in [range.from, range.to] at which the ray is on or below the patch. Its height above
// the patch is a quadratic in t, expanded about the entry so that distant origins lose no digits.
std::optional<double> intersect(const Patch& patch, const GridRay& ray, const RayRange& range, double column,
                                double row) {
  const double u = ray.u + range.from * ray.du - column, v = ray.v + range.from * ray.dv - row;
  const double q2 = -patch.d * ray.du * ray.dv;
  const double q1 = ray.dz - patch.b * ray.du - patch.c * ray.dv - patch.d * (u * ray.dv + v * ray.du);
  const double q0 = ray.z + range.from * ray.dz - patch.height(u, v);
  const double length = range.to - range.from;
  if (q0 <= 0 && !(q0 > -kContactTolerance && q1 > 0)) return range.from;
  const double discriminant = q1 * q1 - 4 * q2 * q0;
  if (discriminant < 0) return std::nullopt;
  const double q = -0.5 * (q1 + std::copysign(std::sqrt(discriminant), q1));
  double first = kInfinity;
  for (const double root : {q2 != 0 ? q / q2 : kInfinity, q != 0 ? q0 / q : kInfinity}) {
    const bool sinks = q1 + 2 * q2 * root <= 0;  // the other root is the exit
    if (sinks && root >= 0 && root <= length) first = std::min(first, root);
  }
  if (first < kInfinity) return range.from + first;
  // Rounding may move a root beyond the shared edge, where both cells would miss it.
  if (q0 + length * (q1 + length * q2) <= 0) return range.to;
  return std::nullopt;
}

struct Node {
  int level = 0;
  std::int32_t column = 0, row = 0;
  double from = 0, to = 0;
};

// Crossings of a ray with the grid lines of one direction.
struct Crossing {
  double start, speed, per_speed;
  Crossing(double begin, double velocity) : start(begin), speed(velocity), per_speed(1 / velocity) {}
  double time(double line) const { return speed != 0 ? (line - start) * per_speed : kInfinity; }
  bool beyond(double line, double crossed, double now) const {  // in the direction of greater values
    return speed > 0 ? now >= crossed : speed < 0 ? now < crossed : start >= line;
  }
};

}  // namespace

Terrain::Pyramid::Pyramid(Grid<float> given, double left, double top, double dx, double dy, double sd)
    : heights(std::move(given)), x0(left), y0(top), step_x(dx), step_y(dy), height_sd(sd) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  min_height = kInfinity, max_height = -kInfinity;
  for (float& h : heights.cells()) {
    if (!std::isfinite(h)) {
      h = kNaN;
      continue;
    }
    min_height = std::min<double>(min_height, h), max_height = std::max<double>(max_height, h);
  }
  ceiling = max_height;
  if (min_height > max_height) min_height = max_height = kNaN, ceiling = kInfinity;

  Grid<float> cells(heights.columns() - 1, heights.rows() - 1);
  for (std::int64_t j = 0; j < cells.rows(); ++j)
    for (std::int64_t i = 0; i < cells.columns(); ++i) {
      const float a = heights(i, j), b = heights(i + 1, j), c = heights(i, j + 1), d = heights(i + 1, j + 1);
      // Unknown terrain may be as high as any known height.
      cells(i, j) = std::isfinite(a + b + c + d) ? std::max({a, b, c, d}) : static_cast<float>(ceiling);
    }
  levels.push_back(std::move(cells));
  while (levels.back().columns() > 1 || levels.back().rows() > 1) {
    const Grid<float>& fine = levels.back();
    Grid<float> coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2);
    for (std::int64_t j = 0; j < coarse.rows(); ++j)
      for (std::int64_t i = 0; i < coarse.columns(); ++i) {
        const std::int64_t i1 = std::min(2 * i + 1, fine.columns() - 1),
                           j1 = std::min(2 * j + 1, fine.rows() - 1);
        coarse(i, j) = std::max({fine(2 * i, 2 * j), fine(i1, 2 * j), fine(2 * i, j1), fine(i1, j1)});
      }
    levels.push_back(std::move(coarse));
  }
}

std::optional<Terrain::Pyramid::CellPosition> Terrain::Pyramid::locate(double x, double y) const {
  const double column = (x - x0) / step_x, row = (y0 - y) / step_y;
  const std::int64_t columns = heights.columns(), rows = heights.rows();
  if (!(column >= 0 && row >= 0 && column <= double(columns - 1) && row <= double(rows - 1)))
    return std::nullopt;
  const auto c = std::min(static_cast<std::int64_t>(column), columns - 2);
  const auto r = std::min(static_cast<std::int64_t>(row), rows - 2);
  return CellPosition{c, r, column - double(c), row - double(r)};
}

Patch Terrain::Pyramid::patch(std::int64_t column, std::int64_t row) const {
  const double h00 = heights(column, row), h10 = heights(column + 1, row), h01 = heights(column, row + 1),
               h11 = heights(column + 1, row + 1);
  return {h00, h10 - h00, h01 - h00, h11 - h10 - h01 + h00};
}

GridRay Terrain::Pyramid::to_grid_ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& along) const {
  return {(origin.x() - x0) / step_x, (y0 - origin.y()) / step_y, origin.z(),
          along.x() / step_x,         -along.y() / step_y,        along.z()};
}

std::optional<RayRange> Terrain::Pyramid::clip_to_extent(const GridRay& ray) const {
  RayRange range{0, kInfinity};
  const auto clip = [&range](double start, double speed, double low, double high) {
    if (speed == 0) {
      if (!(start >= low && start <= high)) range.to = -kInfinity;
      return;
    }
    double enter = (low - start) / speed, leave = (high - start) / speed;
    if (enter > leave) std::swap(enter, leave);
    range.from = std::max(range.from, enter);
    range.to = std::min(range.to, leave);
  };
  clip(ray.u, ray.du, 0, double(heights.columns() - 1));
  clip(ray.v, ray.dv, 0, double(heights.rows() - 1));
  clip(ray.z, ray.dz, -kInfinity, ceiling + kContactTolerance);
  if (!(range.from <= range.to)) return std::nullopt;
  return range;
}

PyramidHit Terrain::Pyramid::first_hit(const GridRay& ray, const RayRange& range,
                                       UnknownCells unknown) const {
  // Front-to-back traversal of the quadtree. Each node splits its piece of the ray at its middle lines, so
  // that pieces join without gaps despite rounding.
  std::array<Node, 128> stack;  // at most 3 per level, 32 levels
  std::size_t size = 0;
  const auto push = [&](int level, std::int32_t i, std::int32_t j, double from, double to) {
    const Grid<float>& bound = levels[std::size_t(level)];
    i = std::min(i, static_cast<std::int32_t>(bound.columns() - 1));
    j = std::min(j, static_cast<std::int32_t>(bound.rows() - 1));
    const double low = std::min(ray.z + from * ray.dz, ray.z + to * ray.dz);
    if (low <= bound(i, j)) stack[size++] = {level, i, j, from, to};
  };
  // Bounds the piece of a ray that descends without end.
  const double deepest = ray.dz < 0 ? (min_height - 1 - ray.z) / ray.dz : kInfinity;
  const double last = std::min(range.to, std::max(range.from, deepest));
  const double end = std::isfinite(last) ? last : range.from;
  // Start at the smallest node that contains both ends of the ray.
  const auto cell = [](double at, std::int64_t count) {
    return static_cast<std::uint32_t>(std::clamp(at, 0.0, double(count - 1)));
  };
  const std::int64_t columns = levels[0].columns(), rows = levels[0].rows();
  const std::uint32_t c = cell(ray.u + range.from * ray.du, columns),
                      c_end = cell(ray.u + end * ray.du, columns);
  const std::uint32_t r = cell(ray.v + range.from * ray.dv, rows), r_end = cell(ray.v + end * ray.dv, rows);
  const int top = std::bit_width((c ^ c_end) | (r ^ r_end));
  push(top, static_cast<std::int32_t>(c >> top), static_cast<std::int32_t>(r >> top), range.from, end);
  const Crossing u(ray.u, ray.du), v(ray.v, ray.dv);
  while (size > 0) {
    const Node node = stack[--size];
    if (node.level == 0) {
      const Patch ground = patch(node.column, node.row);
      if (!ground.known()) {
        if (unknown == UnknownCells::stop) return {RayEnd::no_data, node.from};
        continue;
      }
      if (const auto t = intersect(ground, ray, {node.from, node.to}, node.column, node.row))
        return {RayEnd::ground, *t};
      continue;
    }
    const int below = node.level - 1;
    const std::int32_t column = 2 * node.column, row = 2 * node.row;
    const double half = double(std::int64_t{1} << below);
    const double line_u = (column + 1) * half, line_v = (row + 1) * half;
    const double t_u = u.time(line_u), t_v = v.time(line_v);
    const std::int32_t right = u.beyond(line_u, t_u, node.from), lower = v.beyond(line_v, t_v, node.from);
    const double cut_u = t_u > node.from && t_u < node.to ? t_u : node.to;
    const double cut_v = t_v > node.from && t_v < node.to ? t_v : node.to;
    const double first = std::min(cut_u, cut_v), second = std::max(cut_u, cut_v);
    // The last piece is pushed first.
    if (second < node.to) push(below, column + 1 - right, row + 1 - lower, second, node.to);
    if (first < node.to)
      push(below, column + (cut_u <= cut_v ? 1 - right : right), row + (cut_v <= cut_u ? 1 - lower : lower),
           first, second);
    push(below, column + right, row + lower, node.from, first);
  }
  return {};
}

}  // namespace waymark::inline geo

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/canopy_model.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace waymark::pipeline {
namespace {

constexpr double kHighest = 150;  // metres; returns above are birds and clouds
constexpr double kMaxGap = 8;     // metres, longest edge of the lowest layer

// Value of cells outside the convex hull.
enum class Beyond { nothing, nearest };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<double, Kernel>;
using Tin = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;

std::vector<Eigen::Vector3d> distinct(std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tie(a.x(), a.y(), b.z()) < std::tie(b.x(), b.y(), a.z());  // the highest first
  });
  const auto same = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.head<2>() == b.head<2>();
  };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), same), sorted.end());
  return sorted;
}

// Bounds are sorted, since rows and columns may run in either direction.
std::pair<std::int64_t, std::int64_t> cells_between(double a, double b, std::int64_t count) {
  const double low = std::min(a, b), high = std::max(a, b);
  return {std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(low - 1e-9))),
          std::min<std::int64_t>(count - 1, static_cast<std::int64_t>(std::floor(high + 1e-9)))};
}

void fill(Grid<float>& heights, const CellFrame& frame, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
          const Eigen::Vector3d& c) {
  const Eigen::Vector2d u = (b - a).head<2>(), v = (c - a).head<2>();
  const double area = u.x() * v.y() - u.y() * v.x();
  if (!(std::abs(area) > 0)) return;
  const auto [x_low, x_high] = std::minmax({a.x(), b.x(), c.x()});
  const auto [y_low, y_high] = std::minmax({a.y(), b.y(), c.y()});
  const auto [first, last] =
      cells_between((x_low - frame.x0) / frame.dx, (x_high - frame.x0) / frame.dx, frame.columns);
  const auto [top, bottom] =
      cells_between((y_low - frame.y0) / frame.dy, (y_high - frame.y0) / frame.dy, frame.rows);
  for (std::int64_t r = top; r <= bottom; ++r)
    for (std::int64_t i = first; i <= last; ++i) {
      const Eigen::Vector2d p(frame.x0 + static_cast<double>(i) * frame.dx - a.x(),
                              frame.y0 + static_cast<double>(r) * frame.dy - a.y());
      const double s = (p.x() * v.y() - p.y() * v.x()) / area, t = (u.x() * p.y() - u.y() * p.x()) / area;
      if (s < -1e-9 || t < -1e-9 || s + t > 1 + 1e-9) continue;
      heights(i, r) = static_cast<float>(a.z() + s * (b.z() - a.z()) + t * (c.z() - a.z()));
    }
}

// Interpolates heights at cell centres linearly in the Delaunay triangulation of points (x, y, z); NaN
// outside it. Triangles with an edge longer than `longest_edge` are discarded. Of points at one position
// the highest is used. The order of the points does not matter. About 1 us per point.
Grid<float> rasterised_tin(std::span<const Eigen::Vector3d> points, const CellFrame& frame,
                           double longest_edge, Beyond beyond) {
  Grid<float> heights(frame.columns, frame.rows, std::nanf(""));
  const std::vector<Eigen::Vector3d> all = distinct(points);
  if (all.empty()) return heights;
  std::vector<std::pair<Kernel::Point_2, double>> placed;
  placed.reserve(all.size());
  for (const Eigen::Vector3d& p : all) placed.emplace_back(Kernel::Point_2(p.x(), p.y()), p.z());
  Tin tin(placed.begin(), placed.end());
  const auto corner = [](const Tin::Vertex_handle& v) {
    return Eigen::Vector3d(v->point().x(), v->point().y(), v->info());
  };
  const double longest2 = longest_edge * longest_edge;
  for (auto face = tin.finite_faces_begin(); face != tin.finite_faces_end(); ++face) {
    const Eigen::Vector3d a = corner(face->vertex(0)), b = corner(face->vertex(1)),
                          c = corner(face->vertex(2));
    const double edge2 = std::max(
        {(b - a).head<2>().squaredNorm(), (c - b).head<2>().squaredNorm(), (a - c).head<2>().squaredNorm()});
    if (edge2 <= longest2) fill(heights, frame, a, b, c);
  }
  if (beyond == Beyond::nothing) return heights;
  for (std::int64_t r = 0; r < frame.rows; ++r)
    for (std::int64_t c = 0; c < frame.columns; ++c)
      if (std::isnan(heights(c, r)))
        heights(c, r) = static_cast<float>(
            tin.nearest_vertex(Kernel::Point_2(frame.x0 + static_cast<double>(c) * frame.dx,
                                               frame.y0 + static_cast<double>(r) * frame.dy))
                ->info());
  return heights;
}

// Ground elevation between cell centres.
double ground_at(const Grid<float>& ground, double column, double row) {
  const auto clamp = [](double v, std::int64_t count) {
    return std::clamp(v, 0.0, static_cast<double>(count - 1));
  };
  const double c = clamp(column, ground.columns()), r = clamp(row, ground.rows());
  const auto i = std::min(static_cast<std::int64_t>(c), std::max<std::int64_t>(0, ground.columns() - 2));
  const auto j = std::min(static_cast<std::int64_t>(r), std::max<std::int64_t>(0, ground.rows() - 2));
  const double u = c - static_cast<double>(i), v = r - static_cast<double>(j);
  const std::int64_t i2 = std::min(i + 1, ground.columns() - 1), j2 = std::min(j + 1, ground.rows() - 1);
  return (1 - v) * ((1 - u) * static_cast<double>(ground(i, j)) + u * static_cast<double>(ground(i2, j))) +
         v * ((1 - u) * static_cast<double>(ground(i, j2)) + u * static_cast<double>(ground(i2, j2)));
}

// Returns the pit-free heights of points above the ground, whose elevation `ground` returns between cells of
// the frame.
template <class Ground>
Grid<float> heights_above(const Ground& ground, std::span<const Eigen::Vector3d> surface,
                          const CellFrame& frame, double spacing) {
  Grid<float> heights(frame.columns, frame.rows, std::nanf(""));
  // Highest point of each cell, including a margin around the frame.
  const double cell = frame.dx;
  struct Highest {
    double height = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  const std::int64_t margin = kTerrainMargin;
  Grid<Highest> highest(frame.columns + 2 * margin, frame.rows + 2 * margin);
  for (const Eigen::Vector3d& p : surface) {
    const double column = (p.x() - frame.x0) / frame.dx, row = (p.y() - frame.y0) / frame.dy;
    const auto c = static_cast<std::int64_t>(std::floor(column + 0.5)) + margin;
    const auto r = static_cast<std::int64_t>(std::floor(row + 0.5)) + margin;
    if (!highest.contains(c, r)) continue;
    const double above_ground = p.z() - ground(column, row);
    if (std::isnan(above_ground)) continue;
    const double height = std::max(0.0, above_ground);
    Highest& best = highest(c, r);
    const bool replaces =
        height > best.height ||
        (height == best.height && std::tie(p.x(), p.y()) < std::tie(best.point.x(), best.point.y()));
    if (height <= kHighest && replaces) best = {height, {p.x(), p.y(), height}};
  }
  double tallest = 0;
  for (const Highest& h : highest.cells()) tallest = std::max(tallest, h.height);
  std::vector<Eigen::Vector3d> above;
  for (double threshold = 0; threshold <= tallest; threshold += threshold == 0 ? 2 : threshold == 2 ? 3 : 5) {
    above.clear();
    for (const Highest& h : highest.cells())
      if (h.height >= threshold && h.height >= 0) above.push_back(h.point);
    const double longest = threshold == 0 ? kMaxGap : std::max(1.0, 3 * std::max(cell, spacing));
    const Grid<float> layer = rasterised_tin(above, frame, longest, Beyond::nothing);
    for (std::size_t i = 0; i < layer.cells().size(); ++i) {
      float& h = heights.cells()[i];
      if (!(h >= layer.cells()[i]) && !std::isnan(layer.cells()[i])) h = layer.cells()[i];
    }
  }
  for (std::int64_t r = 0; r < frame.rows; ++r)  // a TIN passes below the highest point of a cell
    for (std::int64_t c = 0; c < frame.columns; ++c) {
      const double own = highest(c + margin, r + margin).height;
      float& h = heights(c, r);
      if (own >= 0 && !(static_cast<double>(h) >= own)) h = static_cast<float>(own);
    }
  return heights;
}

}  // namespace

Grid<float> ground_grid(std::span<const Eigen::Vector3d> ground, const CellFrame& frame) {
  return rasterised_tin(ground, frame, 1e9, Beyond::nearest);
}

CanopyBlock canopy_block(const LaserPoints& points, const CellFrame& frame, double spacing) {
  CanopyBlock block{Grid<float>(frame.columns, frame.rows, std::nanf("")), ground_grid(points.ground, frame)};
  if (points.ground.empty()) return block;
  block.heights =
      heights_above([&](double column, double row) { return ground_at(block.ground, column, row); },
                    points.surface, frame, spacing);
  return block;
}

CanopyBlock canopy_block(std::span<const Eigen::Vector3d> surface, const Grid<float>& terrain,
                         const CellFrame& frame, double spacing) {
  constexpr double kMargin = kTerrainMargin;
  CanopyBlock block{
      heights_above(
          [&](double column, double row) { return ground_at(terrain, column + kMargin, row + kMargin); },
          surface, frame, spacing),
      Grid<float>(frame.columns, frame.rows)};
  for (std::int64_t r = 0; r < frame.rows; ++r)
    for (std::int64_t c = 0; c < frame.columns; ++c) {
      block.ground(c, r) = terrain(c + kTerrainMargin, r + kTerrainMargin);
      if (std::isnan(block.ground(c, r))) block.heights(c, r) = std::nanf("");
    }
  return block;
}

}  // namespace waymark::pipeline

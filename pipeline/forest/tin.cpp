// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tin.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace waymark::pipeline {
namespace {

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

}  // namespace

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

}  // namespace waymark::pipeline

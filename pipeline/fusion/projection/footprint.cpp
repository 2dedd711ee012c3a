// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/fusion/projection/lattice_rings.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"

namespace waymark::pipeline {
namespace {

using Seen = std::optional<Eigen::Vector3d>;

// Returns the ground points of the lattice's corners and edge midpoints; corner (c, r) is entry (2 c, 2 r).
Grid<Seen> cast_lattice(const ImageView& image, const Terrain& terrain, int cells) {
  Grid<Seen> seen(2 * cells + 1, 2 * cells + 1);
  for (std::int64_t r = 0; r < seen.rows(); ++r)
    for (std::int64_t c = 0; c < seen.columns(); ++c) {
      if (c % 2 && r % 2) continue;  // cell centres are not needed
      const double x = static_cast<double>(c * image.columns) / (2.0 * cells) - 0.5;
      const double y = static_cast<double>(r * image.rows) / (2.0 * cells) - 0.5;
      const auto line = viewing_ray(image, {x, y});
      if (!line) continue;
      const RayHit hit = terrain.cast(*line);
      if (hit.end == RayEnd::ground) seen(c, r) = hit.point.xyz;
    }
  return seen;
}

// The midpoint of an edge on continuous ground lies half way between its ends.
bool is_continuous(const Seen& a, const Seen& middle, const Seen& b, double cell) {
  if (!a || !middle || !b) return false;
  const Eigen::Vector2d half = (a->head<2>() + b->head<2>()) / 2;
  const double length = (b->head<2>() - a->head<2>()).norm();
  return (middle->head<2>() - half).norm() <= 0.35 * length + cell;
}

double quad_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& d) {
  const Eigen::Vector2d u = (c - a).head<2>(), v = (d - b).head<2>();
  return std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
}

}  // namespace

Footprint footprint(const ImageView& image, const Terrain& terrain, int cells) {
  const Grid<Seen> seen = cast_lattice(image, terrain, cells);
  const double terrain_cell = std::max(terrain.step_x(), terrain.step_y());
  Grid<std::uint8_t> shown(cells, cells, 0);
  Footprint found;
  std::vector<double> areas;
  for (std::int64_t r = 0; r < cells; ++r)
    for (std::int64_t c = 0; c < cells; ++c) {
      const auto at = [&](int dc, int dr) -> const Seen& { return seen(2 * c + dc, 2 * r + dr); };
      if (!is_continuous(at(0, 0), at(1, 0), at(2, 0), terrain_cell) ||
          !is_continuous(at(2, 0), at(2, 1), at(2, 2), terrain_cell) ||
          !is_continuous(at(2, 2), at(1, 2), at(0, 2), terrain_cell) ||
          !is_continuous(at(0, 2), at(0, 1), at(0, 0), terrain_cell))
        continue;
      shown(c, r) = 1;
      areas.push_back(quad_area(*at(0, 0), *at(2, 0), *at(2, 2), *at(0, 2)));
      found.area += areas.back();
    }
  if (areas.empty()) return found;
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2), areas.end());
  const double pixels = static_cast<double>(image.columns * image.rows) / (1.0 * cells * cells);
  found.gsd = std::sqrt(areas[areas.size() / 2] / pixels);
  for (const auto& corners : lattice_rings(shown)) {
    ImageView::Ring ring;
    for (const LatticeCorner& corner : corners)
      ring.push_back(seen(2 * corner.column, 2 * corner.row)->head<2>());
    found.rings.push_back(std::move(ring));
  }
  return found;
}

bool inside(const ImageView::Ring& ring, const Eigen::Vector2d& point) {
  bool in = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const auto &a = ring[i], &b = ring[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x()) in = !in;
  }
  return in;
}

}  // namespace waymark::pipeline

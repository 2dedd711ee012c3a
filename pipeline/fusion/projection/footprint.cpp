// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pipeline/fusion/projection/viewing_ray.hpp"

namespace waymark::pipeline {
namespace {

using Cells = Grid<std::uint8_t>;

struct Step {
  std::int64_t column, row;
};
constexpr std::array<Step, 4> kRightDownLeftUp{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

bool is_marked(const Cells& cells, std::int64_t c, std::int64_t r) {
  return cells.contains(c, r) && cells(c, r) != 0;
}

// Returns the cells of value `of` connected to the first by edges.
Cells flood(const Cells& cells, LatticeCorner first, std::uint8_t of) {
  Cells filled(cells.columns(), cells.rows(), 0);
  std::vector<LatticeCorner> todo{first};
  filled(first.column, first.row) = 1;
  while (!todo.empty()) {
    const LatticeCorner at = todo.back();
    todo.pop_back();
    for (const Step& step : kRightDownLeftUp) {
      const LatticeCorner next{at.column + step.column, at.row + step.row};
      if (!cells.contains(next.column, next.row) || filled(next.column, next.row)) continue;
      if (cells(next.column, next.row) != of) continue;
      filled(next.column, next.row) = 1;
      todo.push_back(next);
    }
  }
  return filled;
}

// Returns a column of a hole. The part's grid has an empty frame.
std::optional<std::int64_t> hole_column(const Cells& part) {
  const Cells outside = flood(part, {0, 0}, 0);
  for (std::int64_t r = 0; r < part.rows(); ++r)
    for (std::int64_t c = 0; c < part.columns(); ++c)
      if (!part(c, r) && !outside(c, r)) return c;
  return std::nullopt;
}

// Traces the boundary of a part without holes; its cells are on the right.
std::vector<LatticeCorner> trace_boundary(const Cells& part, LatticeCorner start) {
  std::vector<LatticeCorner> ring{start};
  LatticeCorner at = start;
  int heading = 0;  // right: the start is the top left corner of a topmost cell
  do {
    at.column += kRightDownLeftUp[static_cast<std::size_t>(heading)].column;
    at.row += kRightDownLeftUp[static_cast<std::size_t>(heading)].row;
    ring.push_back(at);
    // The cells ahead on the right and on the left of the corner.
    const auto ahead = [&](bool right) {
      const int side = heading + (right ? 0 : 3);
      constexpr std::array<Step, 4> kCell{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
      const Step& cell = kCell[static_cast<std::size_t>(side % 4)];
      return is_marked(part, at.column + cell.column, at.row + cell.row);
    };
    if (!ahead(true))
      heading = (heading + 1) % 4;
    else if (ahead(false))
      heading = (heading + 3) % 4;
  } while (!(at == start && heading == 0));
  return ring;
}

void add_rings(const Cells& cells, std::vector<std::vector<LatticeCorner>>& rings) {
  Cells left = cells;
  for (std::int64_t r = 0; r < cells.rows(); ++r)
    for (std::int64_t c = 0; c < cells.columns(); ++c) {
      if (!left(c, r)) continue;
      Cells part = flood(left, {c, r}, 1);
      for (std::int64_t y = 0; y < cells.rows(); ++y)
        for (std::int64_t x = 0; x < cells.columns(); ++x)
          if (part(x, y)) left(x, y) = 0;
      const auto hole = hole_column(part);
      if (!hole) {
        rings.push_back(trace_boundary(part, {c, r}));
        continue;
      }
      Cells west = part, east = part;
      for (std::int64_t y = 0; y < cells.rows(); ++y)
        for (std::int64_t x = 0; x < cells.columns(); ++x) (x <= *hole ? east : west)(x, y) = 0;
      add_rings(west, rings);
      add_rings(east, rings);
    }
}

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

std::vector<std::vector<LatticeCorner>> lattice_rings(const Grid<std::uint8_t>& marked) {
  Cells framed(marked.columns() + 2, marked.rows() + 2, 0);
  for (std::int64_t r = 0; r < marked.rows(); ++r)
    for (std::int64_t c = 0; c < marked.columns(); ++c) framed(c + 1, r + 1) = marked(c, r) ? 1 : 0;
  std::vector<std::vector<LatticeCorner>> rings;
  add_rings(framed, rings);
  for (auto& ring : rings)
    for (LatticeCorner& corner : ring) --corner.column, --corner.row;
  return rings;
}

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

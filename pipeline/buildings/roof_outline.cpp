// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/roof_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "pipeline/forest/crowns.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinCell = 0.25;     // m
constexpr double kAround = 3;         // m around the region
constexpr double kMaxHole = 9;        // m2: smaller holes are filled
constexpr double kMaxSpacings = 1.0;  // of a cell from the nearest return on the roof

constexpr double kCellSpacings = 0.6;  // least side of a cell

enum class Label : std::uint8_t { none, roof, other };

Window box_of(const std::vector<RoofCellAt>& cells) {
  std::int64_t left = cells[0].column, right = left, top = cells[0].row, bottom = top;
  for (const RoofCellAt& at : cells) {
    left = std::min(left, at.column), right = std::max(right, at.column);
    top = std::min(top, at.row), bottom = std::max(bottom, at.row);
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

std::int64_t cells_around(const RoofCells& cells) {
  return static_cast<std::int64_t>(std::ceil(kAround / std::min(cells.width, cells.height)));
}

/// Cells of a region and their planes, by position.
class RegionCells {
 public:
  RegionCells(const RoofCells& cells, const RoofRegion& region)
      : cells_(cells), region_(region), box_(box_of(region.cells)), in_(box_.columns, box_.rows, 0) {
    plane_ = Grid<std::int32_t>(box_.columns, box_.rows, -1);
    for (const RoofCellAt& at : region.cells) in_(at.column - box_.column, at.row - box_.row) = 1;
    for (std::size_t p = 0; p < region.planes.size(); ++p)
      for (const RoofCellAt& at : region.plane_cells[p])
        plane_(at.column - box_.column, at.row - box_.row) = static_cast<std::int32_t>(p);
  }

  Label label(const SurfacePoint& p, const RoofRules& rules) const {
    if (static_cast<double>(p.height) < rules.min_height || p.is_plant()) return Label::other;
    const auto [c, r] = cells_.cell_of(p.x, p.y);
    double nearest = std::numeric_limits<double>::infinity();
    int inside = 0;
    for (std::int64_t j = r - 1; j <= r + 1; ++j)
      for (std::int64_t i = c - 1; i <= c + 1; ++i) {
        const std::int64_t k = i - box_.column, l = j - box_.row;
        if (!in_.contains(k, l) || !in_(k, l)) continue;
        ++inside;
        if (plane_(k, l) < 0) continue;
        const double d = region_.planes[static_cast<std::size_t>(plane_(k, l))].distance(p.x, p.y, p.z);
        if (std::abs(d) < std::abs(nearest)) nearest = d;
      }
    if (inside == 9 || std::abs(nearest) <= 2 * rules.roughness) return Label::roof;
    return inside > 0 && nearest < 0 ? Label::none : Label::other;
  }

 private:
  const RoofCells& cells_;
  const RoofRegion& region_;
  Window box_;
  Grid<std::uint8_t> in_;
  Grid<std::int32_t> plane_;
};

struct Labelled {
  double x = 0, y = 0;
  Label label = Label::none;
};

/// Labels of square cells; row 0 is the northernmost.
struct LabelGrid {
  double left = 0, top = 0, cell = 1;  // outer corner of the first cell
  Grid<std::uint8_t> roof;

  Eigen::Vector2d corner(const CanopyCell& at) const {
    return {left + static_cast<double>(at.column) * cell, top - static_cast<double>(at.row) * cell};
  }
};

/// Buckets of returns for the nearest of a position.
class Buckets {
 public:
  Buckets(const std::vector<Labelled>& points, double left, double top, double side, std::int64_t columns,
          std::int64_t rows)
      : points_(points), left_(left), top_(top), side_(side), first_(columns, rows, 0) {
    std::vector<std::size_t> of(points.size());
    std::vector<std::uint32_t> count(static_cast<std::size_t>(columns * rows) + 1, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [c, r] = bucket(points[i].x, points[i].y);
      of[i] = static_cast<std::size_t>(r * columns + c);
      ++count[of[i] + 1];
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    starts_ = count;
    order_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) order_[count[of[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// Returns the label of the nearest point within `reach`; of equally near ones the first of the order.
  Label nearest(double x, double y, double reach, double max_roof) const {
    const auto [c, r] = bucket(x, y);
    const auto around = static_cast<std::int64_t>(std::ceil(reach / side_));
    double best = reach * reach;
    Label label = Label::none;
    std::uint32_t of = 0;
    for (std::int64_t j = r - around; j <= r + around; ++j)
      for (std::int64_t i = c - around; i <= c + around; ++i) {
        if (!first_.contains(i, j)) continue;
        const auto at = static_cast<std::size_t>(j * first_.columns() + i);
        for (std::uint32_t k = starts_[at]; k < starts_[at + 1]; ++k) {
          const Labelled& p = points_[order_[k]];
          const double dx = p.x - x, dy = p.y - y, d = dx * dx + dy * dy;
          if (d < best || (d == best && label != Label::none && order_[k] < of))
            best = d, label = p.label, of = order_[k];
        }
      }
    return label == Label::roof && best > max_roof * max_roof ? Label::none : label;
  }

 private:
  std::array<std::int64_t, 2> bucket(double x, double y) const {
    const auto clamp = [](double v, std::int64_t count) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(v)), 0, count - 1);
    };
    return {clamp((x - left_) / side_, first_.columns()), clamp((top_ - y) / side_, first_.rows())};
  }

  const std::vector<Labelled>& points_;
  double left_, top_, side_;
  Grid<std::uint8_t> first_;  // its size only
  std::vector<std::uint32_t> starts_, order_;
};

/// Replaces each cell by the majority of the nine around it.
Grid<std::uint8_t> majority(const Grid<std::uint8_t>& in) {
  Grid<std::uint8_t> out(in.columns(), in.rows(), 0);
  for (std::int64_t r = 0; r < in.rows(); ++r)
    for (std::int64_t c = 0; c < in.columns(); ++c) {
      int sum = 0;
      for (std::int64_t j = r - 1; j <= r + 1; ++j)
        for (std::int64_t i = c - 1; i <= c + 1; ++i) sum += in.contains(i, j) && in(i, j);
      out(c, r) = sum >= 5;
    }
  return out;
}

/// Numbers the 4-connected parts of cells of a value, from 1 by their first cells; returns their sizes.
std::vector<std::int64_t> number_parts(const Grid<std::uint8_t>& in, std::uint8_t value,
                                       Grid<std::int32_t>& number) {
  std::vector<std::int64_t> sizes;
  std::vector<CanopyCell> open;
  for (std::int64_t r = 0; r < in.rows(); ++r)
    for (std::int64_t c = 0; c < in.columns(); ++c) {
      if (in(c, r) != value || number(c, r)) continue;
      sizes.push_back(0);
      const auto own = static_cast<std::int32_t>(sizes.size());
      const auto visit = [&](std::int64_t i, std::int64_t j) {
        if (!in.contains(i, j) || in(i, j) != value || number(i, j)) return;
        number(i, j) = own;
        ++sizes.back();
        open.push_back({i, j});
      };
      visit(c, r);
      while (!open.empty()) {
        const CanopyCell at = open.back();
        open.pop_back();
        visit(at.column - 1, at.row), visit(at.column + 1, at.row);
        visit(at.column, at.row - 1), visit(at.column, at.row + 1);
      }
    }
  return sizes;
}

void fill_small_holes(Grid<std::uint8_t>& roof, std::int64_t max_cells) {
  Grid<std::int32_t> number(roof.columns(), roof.rows(), 0);
  const std::vector<std::int64_t> sizes = number_parts(roof, 0, number);
  for (std::size_t i = 0; i < roof.cells().size(); ++i)
    if (const std::int32_t part = number.cells()[i];
        part > 1 && sizes[static_cast<std::size_t>(part - 1)] < max_cells)  // 1 is the outside
      roof.cells()[i] = 1;
}

RoofRing ring_of(const Outline& outline, const LabelGrid& grid) {
  RoofRing ring;
  for (const CanopyCell& at : outline.ring) ring.push_back(grid.corner(at));
  return ring;
}

LabelGrid label_cells(const Window& box, const RoofCells& cells, const std::vector<Labelled>& points,
                      double spacing) {
  const Eigen::Vector2d first = cells.centre(box.column, box.row);
  LabelGrid grid;
  grid.cell = std::max({kMinCell, cells.width / 2, kCellSpacings * spacing});
  const double margin = static_cast<double>(cells_around(cells)) * cells.width;
  grid.left = first.x() - cells.width / 2 - margin;
  grid.top = first.y() + cells.height / 2 + margin;
  const auto count = [&](double side) { return static_cast<std::int64_t>(std::ceil(side / grid.cell)); };
  grid.roof = Grid<std::uint8_t>(count(static_cast<double>(box.columns) * cells.width + 2 * margin),
                                 count(static_cast<double>(box.rows) * cells.height + 2 * margin), 0);
  const double side = std::max(spacing, grid.cell), reach = std::max(2 * spacing, 1.5 * cells.width);
  const auto buckets_on = [&](std::int64_t n) {
    return static_cast<std::int64_t>(std::ceil(static_cast<double>(n) * grid.cell / side)) + 1;
  };
  const Buckets buckets(points, grid.left, grid.top, side, buckets_on(grid.roof.columns()),
                        buckets_on(grid.roof.rows()));
  const double max_roof = kMaxSpacings * std::max(spacing, grid.cell);
  for (std::int64_t r = 1; r + 1 < grid.roof.rows(); ++r)
    for (std::int64_t c = 1; c + 1 < grid.roof.columns(); ++c) {
      const double x = grid.left + (static_cast<double>(c) + 0.5) * grid.cell,
                   y = grid.top - (static_cast<double>(r) + 0.5) * grid.cell;
      grid.roof(c, r) = buckets.nearest(x, y, reach, max_roof) == Label::roof;
    }
  return grid;
}

RoofOutline outline_part(const LabelGrid& grid, const Grid<std::int32_t>& number, std::int32_t part,
                         std::int64_t cell_count) {
  RoofOutline outline{.cell = grid.cell, .area = static_cast<double>(cell_count) * grid.cell * grid.cell};
  Grid<std::uint8_t> own(grid.roof.columns(), grid.roof.rows(), 0);
  for (std::size_t i = 0; i < own.cells().size(); ++i) own.cells()[i] = number.cells()[i] == part;
  outline.outer = ring_of(outline_of(own, 0, 0), grid);
  Grid<std::int32_t> holes(own.columns(), own.rows(), 0);
  const auto sizes = number_parts(own, 0, holes);
  for (std::int32_t hole = 2; hole <= static_cast<std::int32_t>(sizes.size()); ++hole) {
    Grid<std::uint8_t> of_hole(own.columns(), own.rows(), 0);
    for (std::size_t i = 0; i < of_hole.cells().size(); ++i) of_hole.cells()[i] = holes.cells()[i] == hole;
    RoofRing ring = ring_of(outline_of(of_hole, 0, 0), grid);
    std::ranges::reverse(ring);
    outline.holes.push_back(std::move(ring));
  }
  return outline;
}

}  // namespace

Window roof_surroundings(const RoofCells& cells, const RoofRegion& region) {
  const Window box = box_of(region.cells);
  const std::int64_t around = cells_around(cells) + 1;
  return {(cells.window.column + box.column - around) * cells.step,
          (cells.window.row + box.row - around) * cells.step, (box.columns + 2 * around) * cells.step,
          (box.rows + 2 * around) * cells.step};
}

std::vector<RoofOutline> outline_roof(const RoofCells& cells, const RoofRegion& region,
                                      std::vector<SurfacePoint> returns, const RoofRules& rules) {
  std::ranges::sort(returns, {}, [](const SurfacePoint& p) {
    return std::tuple(p.x, p.y, p.z, p.number, p.of, p.classification);
  });
  const RegionCells of_region(cells, region);
  std::vector<Labelled> labelled;
  std::vector<SurfacePoint> roof;
  for (const SurfacePoint& p : returns) {
    const Label label = of_region.label(p, rules);
    if (label != Label::none) labelled.push_back({p.x, p.y, label});
    if (label == Label::roof) roof.push_back(p);
  }
  if (roof.empty()) return {};
  const double area = static_cast<double>(region.cells.size()) * cells.width * cells.height;
  const double spacing = std::sqrt(area / static_cast<double>(roof.size()));
  LabelGrid grid = label_cells(box_of(region.cells), cells, labelled, spacing);
  fill_small_holes(grid.roof, std::llround(kMaxHole / (grid.cell * grid.cell)));
  grid.roof = majority(grid.roof);
  fill_small_holes(grid.roof, std::llround(kMaxHole / (grid.cell * grid.cell)));
  Grid<std::int32_t> number(grid.roof.columns(), grid.roof.rows(), 0);
  const auto sizes = number_parts(grid.roof, 1, number);
  std::vector<RoofOutline> outlines;
  for (std::size_t part = 0; part < sizes.size(); ++part) {
    RoofOutline outline = outline_part(grid, number, static_cast<std::int32_t>(part + 1), sizes[part]);
    outline.spacing = spacing;
    for (const SurfacePoint& p : roof) {
      const auto c = static_cast<std::int64_t>(std::floor((p.x - grid.left) / grid.cell)),
                 r = static_cast<std::int64_t>(std::floor((grid.top - p.y) / grid.cell));
      if (number.contains(c, r) && number(c, r) == static_cast<std::int32_t>(part + 1))
        outline.roof.push_back(p);
    }
    outline.returns = outline.roof.size();
    outlines.push_back(std::move(outline));
  }
  std::ranges::stable_sort(outlines, std::greater<>(), &RoofOutline::area);
  return outlines;
}

}  // namespace waymark::pipeline

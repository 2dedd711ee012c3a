// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/mosaic_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "geo/georeference.hpp"

namespace waymark::importers {
namespace {

constexpr double kAlignment = 1e-3;  // cells

// Converts cells to longitude and latitude of their centres, degrees, in any CRS.
class CellPositions {
 public:
  explicit CellPositions(const GridGeometry& grid)
      : grid_(grid), transform_(grid.where.crs, geographic_crs(grid.where.crs)) {}
  CrsTransform::XY operator()(std::int64_t column, std::int64_t row) const {
    return transform_(grid_.where.x(static_cast<double>(column)), grid_.where.y(static_cast<double>(row)));
  }

 private:
  const GridGeometry& grid_;
  CrsTransform transform_;
};

// Returns degrees of longitude per column if they are constant and rows have constant latitude.
std::optional<double> degrees_per_column(const GridGeometry& grid, const CellPositions& place) {
  if (grid.columns < 4) return std::nullopt;
  const std::int64_t far = grid.columns / 3;  // less than half a turn even for a global grid
  std::optional<double> step;
  for (const std::int64_t row : {grid.rows / 4, grid.rows / 2, grid.rows * 3 / 4}) {
    const auto a = place(0, row), b = place(far, row);
    const double turned = std::remainder(b.x - a.x, 360) / static_cast<double>(far);
    if (!(turned > 0) || !(std::abs(b.y - a.y) < 1e-9)) return std::nullopt;
    if (step && !(std::abs(turned / *step - 1) < 1e-9)) return std::nullopt;
    step = turned;
  }
  return step;
}

// Marks a grid as wrapping if its columns cover all longitudes, in degrees or in a cylindrical projection.
// Drops the columns that repeat the first ones, and marks the poles it reaches (outermost row within one
// cell of +-90 degrees). Leaves other grids unchanged.
void mark_wraparound(GridGeometry& grid) {
  if (grid.where.crs.kind() == CrsKind::local) return;
  const CellPositions place(grid);
  const auto step = degrees_per_column(grid, place);
  if (!step) return;
  const auto turn = std::llround(360 / *step);  // files round their cell size, so a turn is rarely exact
  if (std::abs(static_cast<double>(turn) * *step - 360) > 0.25 * *step || grid.columns < turn) return;
  grid.columns = turn;
  grid.wraps = true;
  const double top = place(0, 0).y, bottom = place(0, grid.rows - 1).y;
  const double tall = grid.rows > 1 ? (top - bottom) / static_cast<double>(grid.rows - 1) : 0;
  grid.north_pole = 90 - top <= tall * (1 + 1e-6);
  grid.south_pole = 90 + bottom <= tall * (1 + 1e-6);
}

double width(const RasterHeader& header) {
  return static_cast<double>(header.columns) * header.where.dx;
}

// Returns the gdalwarp call that resamples `other` to the grid of `first`: extent in whole cells of that
// grid.
std::string remedy(const RasterHeader& first, const RasterHeader& other) {
  const Georeference &grid = first.where, &o = other.where;
  const auto edge_x = [&](double column) { return grid.x(column - 0.5); };
  const auto edge_y = [&](double row) { return grid.y(row - 0.5); };
  const double left = std::floor(grid.column(o.x(-0.5)) + 0.5), top = std::floor(grid.row(o.y(-0.5)) + 0.5);
  const double right = std::ceil(grid.column(o.x(static_cast<double>(other.columns) - 0.5)) + 0.5);
  const double bottom = std::ceil(grid.row(o.y(static_cast<double>(other.rows) - 0.5)) + 0.5);
  return fmt::format(
      "put it on the first file's grid: gdalwarp -r bilinear -tr {} {} -te {} {} {} {} '{}' aligned.tif",
      grid.dx, -grid.dy, edge_x(left), edge_y(bottom), edge_x(right), edge_y(top), other.path);
}

void check_same_grid(const RasterHeader& first, const RasterHeader& other) {
  const Georeference &a = first.where, &b = other.where;
  const std::string both = first.path + " and " + other.path;
  if (!a.crs.same_as(b.crs))
    throw Error(
        ErrorCode::input,
        fmt::format("the files are in different coordinate systems: {} and {}", a.crs.id(), b.crs.id()), both,
        fmt::format("convert one: gdalwarp -t_srs '{}' '{}' converted.tif",
                    a.crs.code().empty() ? first.path : a.crs.id(), other.path));
  const auto cells = static_cast<double>(std::max({first.columns, first.rows, other.columns, other.rows}));
  if (!(std::abs(a.dx - b.dx) * cells <= kAlignment * a.dx &&
        std::abs(a.dy - b.dy) * cells <= -kAlignment * a.dy))
    throw Error(
        ErrorCode::input,
        fmt::format("the files have cells of different size: {} x {} and {} x {}", a.dx, -a.dy, b.dx, -b.dy),
        both, remedy(first, other));
  const double columns = a.column(b.x0), rows = a.row(b.y0);
  const double off_x = columns - std::round(columns), off_y = rows - std::round(rows);
  if (!(std::abs(off_x) <= kAlignment && std::abs(off_y) <= kAlignment))
    throw Error(
        ErrorCode::input,
        fmt::format("the files' cells do not lie on one grid: they are {:.3f} columns and {:.3f} rows apart",
                    off_x, off_y),
        both, remedy(first, other));
}

// Shifts longitudes by whole turns so that the files span the shortest interval, outside the widest gap
// on the circle. An interval that is already the shortest stays unchanged.
void join_across_antimeridian(std::vector<RasterHeader>& headers) {
  if (headers.size() < 2 || headers[0].where.crs.kind() != CrsKind::geographic) return;
  const auto west = [](const RasterHeader& h) { return h.where.x(-0.5); };
  const auto east = [&](const RasterHeader& h) { return west(h) + width(h); };
  const auto by_west = [&](const RasterHeader& a, const RasterHeader& b) { return west(a) < west(b); };
  const double origin = west(*std::ranges::min_element(headers, by_west));
  std::vector<std::pair<double, double>> stretches;
  for (const RasterHeader& h : headers) {
    const double from = west(h) - 360 * std::floor((west(h) - origin) / 360 + 1e-9);
    stretches.emplace_back(from, from + east(h) - west(h));
  }
  std::ranges::sort(stretches);
  double reach = stretches[0].second, widest = 0, start = origin;
  for (const auto& [from, to] : stretches) {
    if (from - reach > widest) {
      widest = from - reach;
      start = from;
    }
    reach = std::max(reach, to);
  }
  if (origin + 360 - reach >= widest - 1e-9) start = origin;  // the gap is at the numeric ends
  for (RasterHeader& h : headers) h.where.x0 -= 360 * std::floor((west(h) - start) / 360 + 1e-9);
}

}  // namespace

MosaicLayout lay_out(const std::vector<RasterHeader>& given) {
  std::vector<RasterHeader> headers = given;
  join_across_antimeridian(headers);
  const RasterHeader& first = headers.front();
  MosaicLayout layout;
  std::int64_t left = 0, top = 0, right = 0, bottom = 0;
  for (const RasterHeader& header : headers) {
    check_same_grid(first, header);
    const Window window{std::llround(first.where.column(header.where.x0)),
                        std::llround(first.where.row(header.where.y0)), header.columns, header.rows};
    left = std::min(left, window.column);
    top = std::min(top, window.row);
    right = std::max(right, window.end_column());
    bottom = std::max(bottom, window.end_row());
    layout.files.push_back(window);
  }
  for (Window& window : layout.files) {
    window.column -= left;
    window.row -= top;
  }
  GridGeometry& grid = layout.grid;
  grid = {.columns = right - left, .rows = bottom - top, .where = first.where};
  grid.where.x0 = first.where.x(static_cast<double>(left));
  grid.where.y0 = first.where.y(static_cast<double>(top));
  mark_wraparound(grid);
  return layout;
}

}  // namespace waymark::importers

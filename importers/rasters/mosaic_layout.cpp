// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/mosaic_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "importers/rasters/wraparound.hpp"

namespace waymark::importers {
namespace {

constexpr double kAlignment = 1e-3;  // cells

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

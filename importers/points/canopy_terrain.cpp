// SPDX-License-Identifier: Apache-2.0
#include "importers/points/canopy_terrain.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <cmath>
#include <tuple>

#include "core/error.hpp"
#include "geo/metric_crs.hpp"
#include "importers/gdal_session.hpp"

namespace waymark::importers {
namespace {

bool names_unit(const std::string& file) {
  const GdalDataset dataset = open_raster(file);
  return dataset->GetRasterCount() > 0 && *dataset->GetRasterBand(1)->GetUnitType() != '\0';
}

// Interpolates bilinearly between the cells of `grid`; NaN if one of the four is unknown.
float between(const HeightWindow& heights, double column, double row) {
  const double c = std::floor(column), r = std::floor(row);
  const double u = column - c, v = row - r;
  const auto at = [&](double dc, double dr) {
    const auto i = static_cast<std::int64_t>(c + dc), j = static_cast<std::int64_t>(r + dr);
    return heights.contains(i, j) ? heights(i, j) : kNoHeight;
  };
  double sum = 0;
  for (const auto& [dc, dr, weight] : {std::tuple{0.0, 0.0, (1 - u) * (1 - v)},
                                       {1.0, 0.0, u * (1 - v)},
                                       {0.0, 1.0, (1 - u) * v},
                                       {1.0, 1.0, u * v}})
    if (weight > 1e-9) sum += weight * at(dc, dr);
  return std::isfinite(sum) ? static_cast<float>(sum) : std::nanf("");
}

}  // namespace

std::string crs_for(const std::string& file, const std::string& crs, std::vector<std::string>& warnings) {
  if (!crs.empty()) return crs;
  const GdalDataset dataset = open_raster(file);
  if (dataset->GetSpatialRef() != nullptr) return {};
  double t[6];
  if (dataset->GetGeoTransform(t) == CE_None && std::abs(t[1]) < 0.001)
    return {};  // degrees: import_dem throws
  warnings.push_back(fmt::format(
      "{}: it has no coordinate reference system; its coordinates are taken as metres: pass --crs", file));
  return "local";
}

std::shared_ptr<const ImportedDem> open_heights(const std::vector<std::string>& files,
                                                const CanopyImport& import, const char* what,
                                                std::vector<std::string>& warnings) {
  DemImport how{.files = files,
                .nodata = NodataPolicy::unknown,
                .crs = files.empty() ? import.crs : crs_for(files[0], import.crs, warnings),
                .memory_bytes = import.memory_bytes,
                .inspect = false};
  const GridGeometry grid = import_dem(how)->geometry();
  const Crs& crs = grid.where.crs;
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::input,
                fmt::format("the {} is in degrees ({}), but crowns and distances between trees are in metres",
                            what, crs.id()),
                files[0],
                fmt::format("reproject it first: gdalwarp -t_srs {} '{}' OUT.tif", fitting_metric_crs(grid),
                            files[0]));
  const double unit = crs.metres_per_unit();
  const bool is_in_unit_of_crs = std::abs(unit - 1) > 1e-9 && !names_unit(files[0]);
  how.inspect = import.inspect;
  if (is_in_unit_of_crs) how.height_scale = unit;
  auto raster = import_dem(how);
  warnings.insert(warnings.end(), raster->warnings().begin(), raster->warnings().end());
  if (is_in_unit_of_crs)
    warnings.push_back(fmt::format(
        "{}: the CRS counts in units of {:.6g} m and the band names no unit: heights are taken to be in the "
        "same unit; name it with gdal_edit.py -units m (or ft) if they are not",
        files[0], unit));
  return raster;
}

CanopyTerrain::CanopyTerrain(const CanopyImport& import, const GridGeometry& surface,
                             std::vector<std::string>& warnings)
    : raster_(open_heights(import.dtm, import, "terrain model", warnings)), surface_(surface) {
  const GridGeometry &a = surface_, &b = raster_->geometry();
  if (!a.where.crs.same_as(b.where.crs))
    throw Error(ErrorCode::input,
                fmt::format("the surface is in {}, the terrain in {}", a.where.crs.id(), b.where.crs.id()),
                import.dtm[0],
                a.where.crs.kind() == CrsKind::local
                    ? "pass --crs, which then holds for both"
                    : fmt::format("reproject the terrain: gdalwarp -t_srs {} -r bilinear '{}' dtm.tif",
                                  a.where.crs.id(), import.dtm[0]));
  const double shift_x = (a.where.x0 - b.where.x0) / a.where.dx,
               shift_y = (a.where.y0 - b.where.y0) / a.where.dy;
  same_grid_ = std::abs(a.where.dx / b.where.dx - 1) < 1e-6 && std::abs(a.where.dy / b.where.dy - 1) < 1e-6 &&
               std::abs(shift_x) < 1e-3 && std::abs(shift_y) < 1e-3;
  const bool apart = a.where.x(static_cast<double>(a.columns)) < b.where.x(-1) ||
                     b.where.x(static_cast<double>(b.columns)) < a.where.x(-1) ||
                     a.where.y(static_cast<double>(a.rows)) > b.where.y(-1) ||
                     b.where.y(static_cast<double>(b.rows)) > a.where.y(-1);
  if (apart)
    throw Error(ErrorCode::input, "surface and terrain do not overlap", import.dtm[0],
                "check that both cover the same area and are in the same CRS");
  if (!same_grid_ && import.las.empty())  // the grid of a canopy from points is ours
    warnings.push_back(
        fmt::format("{}: its grid (cells of {:g}) is not that of the surface (cells of {:g}): the terrain "
                    "is interpolated",
                    import.dtm[0], b.where.dx, a.where.dx));
}

bool CanopyTerrain::covers_surface() const {
  const Georeference &to = raster_->geometry().where, &from = surface_.where;
  const GridGeometry& grid = raster_->geometry();
  const auto last = [](std::int64_t count) { return static_cast<double>(count - 1); };
  return to.column(from.x(0)) >= 0 && to.row(from.y(0)) >= 0 &&
         to.column(from.x(last(surface_.columns))) <= last(grid.columns) &&
         to.row(from.y(last(surface_.rows))) <= last(grid.rows);
}

Grid<float> CanopyTerrain::at(const Window& window) const {
  if (!same_grid_) return between_cells(window);
  Grid<float> ground(window.columns, window.rows);
  const HeightWindow heights = raster_->read(window);
  for (std::size_t i = 0; i < heights.cells().size(); ++i) {
    const double h = heights.cells()[i];
    ground.cells()[i] = h == kNoHeight ? std::nanf("") : static_cast<float>(h);
  }
  return ground;
}

Grid<float> CanopyTerrain::between_cells(const Window& window) const {
  Grid<float> ground(window.columns, window.rows);
  const Georeference &to = raster_->geometry().where, &from = surface_.where;
  const auto column_of = [&](std::int64_t c) {
    return to.column(from.x(static_cast<double>(window.column + c)));
  };
  const auto row_of = [&](std::int64_t r) { return to.row(from.y(static_cast<double>(window.row + r))); };
  Window part{static_cast<std::int64_t>(std::floor(column_of(0))),
              static_cast<std::int64_t>(std::floor(row_of(0)))};
  part.columns = static_cast<std::int64_t>(std::floor(column_of(window.columns - 1))) + 2 - part.column;
  part.rows = static_cast<std::int64_t>(std::floor(row_of(window.rows - 1))) + 2 - part.row;
  const HeightWindow heights = raster_->read(part);
  for (std::int64_t r = 0; r < window.rows; ++r)
    for (std::int64_t c = 0; c < window.columns; ++c)
      ground(c, r) = between(heights, column_of(c) - static_cast<double>(part.column),
                             row_of(r) - static_cast<double>(part.row));
  return ground;
}

}  // namespace waymark::importers

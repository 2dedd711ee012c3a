// SPDX-License-Identifier: Apache-2.0
#include "importers/points/canopy.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "core/error.hpp"
#include "geo/metric_crs.hpp"
#include "importers/gdal_session.hpp"
#include "importers/points/inspect_canopy.hpp"
#include "importers/rasters/dem.hpp"

namespace waymark::importers {
namespace {

constexpr float kMaxHeight = 150;  // metres; the tallest tree known has 116

struct Raster {
  std::shared_ptr<const ImportedDem> dem;
  double metres = 1;  // per unit of its numbers, after the unit of its band
};

// Returns the CRS to open a file with: "local" if it names none.
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

bool names_unit(const std::string& file) {
  const GdalDataset dataset = open_raster(file);
  return dataset->GetRasterCount() > 0 && *dataset->GetRasterBand(1)->GetUnitType() != '\0';
}

Raster open(const std::vector<std::string>& files, const CanopyImport& import, const char* what,
            std::vector<std::string>& warnings) {
  DemImport how{.files = files,
                .nodata = NodataPolicy::unknown,
                .crs = files.empty() ? import.crs : crs_for(files[0], import.crs, warnings),
                .memory_bytes = import.memory_bytes,
                .inspect = import.inspect};
  Raster raster{import_dem(how)};
  const Crs& crs = raster.dem->geometry().where.crs;
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::input,
                fmt::format("the {} is in degrees ({}), but crowns and distances between trees are in metres",
                            what, crs.id()),
                files[0],
                fmt::format("reproject it first: gdalwarp -t_srs {} '{}' OUT.tif",
                            fitting_metric_crs(raster.dem->geometry()), files[0]));
  warnings.insert(warnings.end(), raster.dem->warnings().begin(), raster.dem->warnings().end());
  const double unit = crs.metres_per_unit();
  if (std::abs(unit - 1) > 1e-9 && !names_unit(files[0])) {
    raster.metres = unit;
    warnings.push_back(fmt::format(
        "{}: the CRS counts in units of {:.6g} m and the band names no unit: heights are taken to be in the "
        "same unit; name it with gdal_edit.py -units m (or ft) if they are not",
        files[0], unit));
  }
  return raster;
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

class RasterCanopy final : public ImportedCanopy {
 public:
  explicit RasterCanopy(const CanopyImport& import) : import_(import) {
    const bool heights = !import.chm.empty();
    top_ = heights ? open(import.chm, import, "canopy height model", warnings_)
                   : open(import.dsm, import, "surface model", warnings_);
    if (!heights) open_terrain();
    if (!import.forest_type.empty()) open_types();
    const std::string& first = heights ? import.chm[0] : import.dsm[0];
    name_ = import.name.empty() ? std::filesystem::path(first).filename().string() : import.name;
    if (import.inspect)
      for (std::string& warning : inspect_canopy(*this, heights ? "" : import.dtm[0], first, raw_reader()))
        warnings_.push_back(std::move(warning));
    read_area();
  }

  const GridGeometry& geometry() const override { return top_.dem->geometry(); }
  const std::string& name() const override { return name_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  const CanopyImport& import() const override { return import_; }
  DemHandle terrain() const override { return terrain_.dem; }

  Grid<float> read(const Window& window) const override {
    Grid<float> heights = raw(window);
    for (float& h : heights.cells()) h = !(h <= kMaxHeight) || h == kNoCanopy ? kNoCanopy : std::max(h, 0.0F);
    return heights;
  }

  double ground_elevation(std::int64_t column, std::int64_t row) const override {
    if (!terrain_.dem) return std::nan("");
    return ground_in({column, row, 1, 1})(0, 0);
  }

  Grid<std::uint8_t> forest_types(const Window& window) const override {
    if (!types_) return {};
    Grid<std::uint8_t> types(window.columns, window.rows, 0);
    const Georeference &to = types_->geometry().where, &from = geometry().where;
    const auto column_of = [&](std::int64_t c) {
      return std::llround(to.column(from.x(static_cast<double>(window.column + c))));
    };
    const auto row_of = [&](std::int64_t r) {
      return std::llround(to.row(from.y(static_cast<double>(window.row + r))));
    };
    const Window all{column_of(0), row_of(0), column_of(window.columns - 1) - column_of(0) + 1,
                     row_of(window.rows - 1) - row_of(0) + 1};
    const HeightWindow values = types_->read(all);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c) {
        const double v = values(column_of(c) - all.column, row_of(r) - all.row);
        if (v >= 1 && v <= 3 && v == std::floor(v)) types(c, r) = static_cast<std::uint8_t>(v);
      }
    return types;
  }

 private:
  CanopyReader raw_reader() const {
    return [this](const Window& window) { return raw(window); };
  }

  // Heights as in the rasters, negative and absurd ones included.
  Grid<float> raw(const Window& window) const {
    const HeightWindow top = top_.dem->read(window);
    Grid<float> heights(window.columns, window.rows, kNoCanopy);
    const auto metres = static_cast<float>(top_.metres);
    if (!terrain_.dem) {
      for (std::size_t i = 0; i < top.cells().size(); ++i)
        if (top.cells()[i] != kNoHeight) heights.cells()[i] = metres * static_cast<float>(top.cells()[i]);
      return heights;
    }
    const Grid<float> below = ground_in(window);
    for (std::size_t i = 0; i < top.cells().size(); ++i)
      if (top.cells()[i] != kNoHeight && !std::isnan(below.cells()[i]))
        heights.cells()[i] =
            static_cast<float>(top_.metres * top.cells()[i] - static_cast<double>(below.cells()[i]));
    return heights;
  }

  // Returns the ground elevation at the cells of the surface, metres; NaN if unknown.
  Grid<float> ground_in(const Window& window) const {
    Grid<float> ground(window.columns, window.rows);
    const auto metres = static_cast<float>(terrain_.metres);
    if (same_grid_) {
      const HeightWindow heights = terrain_.dem->read(window);
      for (std::size_t i = 0; i < heights.cells().size(); ++i) {
        const double h = heights.cells()[i];
        ground.cells()[i] = h == kNoHeight ? std::nanf("") : metres * static_cast<float>(h);
      }
      return ground;
    }
    const Georeference &to = terrain_.dem->geometry().where, &from = geometry().where;
    const auto column_of = [&](std::int64_t c) {
      return to.column(from.x(static_cast<double>(window.column + c)));
    };
    const auto row_of = [&](std::int64_t r) { return to.row(from.y(static_cast<double>(window.row + r))); };
    Window part{static_cast<std::int64_t>(std::floor(column_of(0))),
                static_cast<std::int64_t>(std::floor(row_of(0)))};
    part.columns = static_cast<std::int64_t>(std::floor(column_of(window.columns - 1))) + 2 - part.column;
    part.rows = static_cast<std::int64_t>(std::floor(row_of(window.rows - 1))) + 2 - part.row;
    const HeightWindow heights = terrain_.dem->read(part);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c)
        ground(c, r) = metres * between(heights, column_of(c) - static_cast<double>(part.column),
                                        row_of(r) - static_cast<double>(part.row));
    return ground;
  }

  void open_terrain() {
    terrain_ = open(import_.dtm, import_, "terrain model", warnings_);
    const GridGeometry &a = geometry(), &b = terrain_.dem->geometry();
    if (!a.where.crs.same_as(b.where.crs))
      throw Error(ErrorCode::input,
                  fmt::format("the surface is in {}, the terrain in {}", a.where.crs.id(), b.where.crs.id()),
                  import_.dtm[0],
                  fmt::format("reproject the terrain: gdalwarp -t_srs {} -r bilinear '{}' dtm.tif",
                              a.where.crs.id(), import_.dtm[0]));
    const double shift_x = (a.where.x0 - b.where.x0) / a.where.dx,
                 shift_y = (a.where.y0 - b.where.y0) / a.where.dy;
    same_grid_ = std::abs(a.where.dx / b.where.dx - 1) < 1e-6 &&
                 std::abs(a.where.dy / b.where.dy - 1) < 1e-6 && std::abs(shift_x) < 1e-3 &&
                 std::abs(shift_y) < 1e-3;
    const bool apart = a.where.x(static_cast<double>(a.columns)) < b.where.x(-1) ||
                       b.where.x(static_cast<double>(b.columns)) < a.where.x(-1) ||
                       a.where.y(static_cast<double>(a.rows)) > b.where.y(-1) ||
                       b.where.y(static_cast<double>(b.rows)) > a.where.y(-1);
    if (apart)
      throw Error(ErrorCode::input, "surface and terrain do not overlap", import_.dtm[0],
                  "check that both cover the same area and are in the same CRS");
    if (!same_grid_)
      warnings_.push_back(
          fmt::format("{}: its grid (cells of {:g}) is not that of the surface (cells of {:g}): the terrain "
                      "is interpolated",
                      import_.dtm[0], b.where.dx, a.where.dx));
  }

  void open_types() {
    types_ = import_dem({.files = {import_.forest_type},
                         .nodata = NodataPolicy::unknown,
                         .crs = crs_for(import_.forest_type, import_.crs, warnings_),
                         .memory_bytes = import_.memory_bytes / 4,
                         .inspect = false});
    if (!types_->geometry().where.crs.same_as(geometry().where.crs))
      throw Error(ErrorCode::input,
                  fmt::format("the canopy is in {}, the raster of forest types in {}",
                              geometry().where.crs.id(), types_->geometry().where.crs.id()),
                  import_.forest_type, "reproject it: gdalwarp -r near");
  }

  CanopyImport import_;
  std::vector<std::string> warnings_;
  Raster top_, terrain_;
  bool same_grid_ = true;
  std::shared_ptr<const ImportedDem> types_;
  std::string name_;
};

void check(const CanopyImport& import) {
  if (!import.chm.empty() && (!import.dsm.empty() || !import.dtm.empty()))
    throw Error(ErrorCode::usage, "a canopy height model and a surface or terrain model are given", "",
                "a canopy height model needs neither; or leave it out and give --dsm and --dtm");
  if (import.chm.empty() && import.dsm.empty())
    throw Error(ErrorCode::usage, "no canopy is given", "",
                "name its files: --chm CHM.tif, --dsm and --dtm, or --las POINTS.las");
  if (import.chm.empty() && import.dtm.empty())
    throw Error(ErrorCode::usage, "heights of trees need the ground under the surface model", import.dsm[0],
                "add --dtm DTM.tif; a raster of heights above ground is passed as --chm");
}

}  // namespace

void ImportedCanopy::read_area() {
  if (const std::string& area = import().area; !area.empty())
    area_ = read_area_of_interest(area, geometry().where.crs);
}

std::shared_ptr<const ImportedCanopy> import_canopy(const CanopyImport& import) {
  if (!import.las.empty()) return import_points(import);
  check(import);
  return std::make_shared<const RasterCanopy>(import);
}

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#include "importers/points/canopy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "importers/points/canopy_terrain.hpp"
#include "importers/points/inspect_canopy.hpp"
#include "importers/rasters/dem.hpp"

namespace waymark::importers {
namespace {

constexpr float kMaxHeight = 150;  // metres; the tallest tree known has 116

class RasterCanopy final : public ImportedCanopy {
 public:
  explicit RasterCanopy(const CanopyImport& import) : import_(import) {
    const bool heights = !import.chm.empty();
    top_ = heights ? open_heights(import.chm, import, "canopy height model", warnings_)
                   : open_heights(import.dsm, import, "surface model", warnings_);
    if (!heights) terrain_ = CanopyTerrain(import_, geometry(), warnings_);
    if (!import.forest_type.empty()) open_types();
    const std::string& first = heights ? import.chm[0] : import.dsm[0];
    name_ = import.name.empty() ? std::filesystem::path(first).filename().string() : import.name;
    if (import.inspect)
      for (std::string& warning : inspect_canopy(*this, heights ? "" : import.dtm[0], first, raw_reader()))
        warnings_.push_back(std::move(warning));
    read_area();
  }

  const GridGeometry& geometry() const override { return top_->geometry(); }
  const std::string& name() const override { return name_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  const CanopyImport& import() const override { return import_; }
  DemHandle terrain() const override { return terrain_.dem(); }

  Grid<float> read(const Window& window) const override {
    Grid<float> heights = raw(window);
    for (float& h : heights.cells()) h = !(h <= kMaxHeight) || h == kNoCanopy ? kNoCanopy : std::max(h, 0.0F);
    return heights;
  }

  double ground_elevation(std::int64_t column, std::int64_t row) const override {
    if (!terrain_.is_open()) return std::nan("");
    return static_cast<double>(terrain_.at({column, row, 1, 1})(0, 0));
  }

  Grid<float> ground(const Window& window) const override {
    if (terrain_.is_open()) return terrain_.at(window);
    return Grid<float>(window.columns, window.rows, std::nanf(""));
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
    const HeightWindow top = top_->read(window);
    Grid<float> heights(window.columns, window.rows, kNoCanopy);
    if (!terrain_.is_open()) {
      for (std::size_t i = 0; i < top.cells().size(); ++i)
        if (top.cells()[i] != kNoHeight) heights.cells()[i] = static_cast<float>(top.cells()[i]);
      return heights;
    }
    const Grid<float> below = terrain_.at(window);
    for (std::size_t i = 0; i < top.cells().size(); ++i)
      if (top.cells()[i] != kNoHeight && !std::isnan(below.cells()[i]))
        heights.cells()[i] = static_cast<float>(top.cells()[i] - static_cast<double>(below.cells()[i]));
    return heights;
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
  std::shared_ptr<const ImportedDem> top_;
  CanopyTerrain terrain_;
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

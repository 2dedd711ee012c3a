// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/cratered_relief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/error.hpp"
#include "core/units.hpp"
#include "geo/crs.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::workflows {
namespace {

// Metres from row to row, and metres from column to column over that for each row. Both are measured on the
// body, so that they hold for any projection that has north up.
struct CellSizes {
  double height = 0;
  std::vector<double> widths;
};

CellSizes measure_cells(const GridGeometry& grid, const CrsTransform& to_lonlat, double radius) {
  const auto at = [&](double column, double row) {
    return to_lonlat(grid.where.x(column), grid.where.y(row));
  };
  const double middle = double(grid.columns - 1) / 2, metres = radius * kRadiansPerDegree;
  CellSizes sizes;
  const double last = double(grid.rows - 1);
  sizes.height = std::abs(at(middle, 0).y - at(middle, last).y) * metres / last;
  for (std::int64_t row = 0; row < grid.rows; ++row) {
    const auto west = at(middle - 0.5, double(row)), east = at(middle + 0.5, double(row));
    sizes.widths.push_back((east.x - west.x) * std::cos(west.y * kRadiansPerDegree) * metres / sizes.height);
  }
  return sizes;
}

std::size_t column_of(const importers::TableSource& table, const std::string& name) {
  const auto& columns = table.header().columns;
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end())
    throw Error(ErrorCode::input, fmt::format("the catalogue has no column '{}'", name), table.header().path,
                "it needs lon, lat (degrees), diameter and depth (metres)");
  return static_cast<std::size_t>(found - columns.begin());
}

void add_catalogue(pipeline::CrateredRelief& relief, const std::string& path, const GridGeometry& grid,
                   const CrsTransform& from_lonlat, double cell) {
  const auto table = importers::open_table(path, importers::TableFormat::by_name, "", "crater");
  const std::array columns{column_of(*table, "lon"), column_of(*table, "lat"), column_of(*table, "diameter"),
                           column_of(*table, "depth")};
  importers::TableRow row;
  while (table->next(row)) {
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto value = importers::to_real(row.cells.at(columns[i]), table->header().decimal_comma);
      if (!value)
        throw Error(ErrorCode::input, fmt::format("'{}' is no number", row.cells.at(columns[i])),
                    table->row_location(row));
      values[i] = *value;
    }
    const auto [lon, lat, diameter, depth] = values;
    if (!(diameter > 0))
      throw Error(ErrorCode::input, "the diameter is not above 0", table->row_location(row));
    const auto at = from_lonlat(lon, lat);
    relief.craters.push_back(
        {grid.where.column(at.x), grid.where.row(at.y), diameter / cell, depth / diameter});
  }
}

}  // namespace

pipeline::CrateredRelief read_cratered_relief(const std::string& dem_and_catalogue, int side) {
  const std::size_t comma = dem_and_catalogue.rfind(',');
  if (comma == std::string::npos)
    throw Error(ErrorCode::usage, fmt::format("'{}' names no catalogue", dem_and_catalogue), "train craters",
                "give --relief DEM,CATALOGUE");
  importers::DemImport import;
  import.files = {dem_and_catalogue.substr(0, comma)};
  const auto dem = importers::import_dem(import);
  const GridGeometry& grid = dem->geometry();
  const std::string& where = import.files[0];
  const auto needed = static_cast<std::int64_t>(std::ceil(1.44 * side / pipeline::kMinReliefZoom)) + 2;
  if (grid.columns < needed || grid.rows < needed)
    throw Error(
        ErrorCode::input,
        fmt::format("the DEM has {} x {} cells, too few for scenes of craters", grid.columns, grid.rows),
        where, fmt::format("it must have {0} x {0}", needed));
  if (grid.where.crs.kind() == CrsKind::local)
    throw Error(ErrorCode::input, "the DEM has no CRS, so the catalogue's positions cannot be found", where);
  const Crs lonlat = geographic_crs(grid.where.crs);
  const CellSizes sizes =
      measure_cells(grid, CrsTransform(grid.where.crs, lonlat), grid.where.crs.body().mean_radius());
  pipeline::CrateredRelief relief;
  relief.cell_widths = sizes.widths;
  relief.heights = Grid<float>(grid.columns, grid.rows);
  for (std::int64_t row = 0; row < grid.rows; ++row) {
    const HeightWindow line = dem->read({0, row, grid.columns, 1});
    for (std::int64_t column = 0; column < grid.columns; ++column) {
      const double height = line(column, 0);
      if (!std::isfinite(height))
        throw Error(ErrorCode::input, "the DEM has cells without a height", where, "fill or crop them");
      relief.heights(column, row) = static_cast<float>(height / sizes.height);
    }
  }
  add_catalogue(relief, dem_and_catalogue.substr(comma + 1), grid, CrsTransform(lonlat, grid.where.crs),
                sizes.height);
  return relief;
}

}  // namespace waymark::workflows

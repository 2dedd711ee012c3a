// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/dem_coverage.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

constexpr std::int64_t kSide = 256;                              // cells of a tile
constexpr float kNoData = std::numeric_limits<float>::lowest();  // far below any height of any body

using Tile = Grid<float>;

/// Returns the mean of the known cells among four; kNoData if there is none.
float mean_of(std::initializer_list<float> four) {
  double sum = 0;
  int known = 0;
  for (const float height : four) {
    if (height == kNoData) continue;
    sum += static_cast<double>(height);
    ++known;
  }
  return known == 0 ? kNoData : static_cast<float>(sum / known);
}

/// Traverses the quadtree of tiles from coarse to fine and stores each tile after its children.
class Pyramid {
 public:
  Pyramid(const sqlite::Database& database, const DemSource& dem)
      : dem_(&dem),
        database_(&database),
        tile_(database.prepare(
            "INSERT INTO dem (zoom_level, tile_column, tile_row, tile_data) VALUES (?, ?, ?, ?)")),
        ancillary_(database.prepare(
            "INSERT INTO gpkg_2d_gridded_tile_ancillary (tpudt_name, tpudt_id, min, max, mean)"
            "  VALUES ('dem', ?, ?, ?, ?)")) {
    const GridGeometry& grid = dem.geometry();
    const auto tiles = static_cast<std::uint64_t>((std::max(grid.columns, grid.rows) + kSide - 1) / kSide);
    finest_ = static_cast<int>(std::bit_width(tiles - 1));
  }

  int finest() const { return finest_; }
  void store_all() { store(0, 0, 0); }

 private:
  std::optional<Tile> store(int zoom, std::int64_t column, std::int64_t row) {
    const std::int64_t cells = kSide << (finest_ - zoom);  // of the DEM along a side of the tile
    const GridGeometry& grid = dem_->geometry();
    if (column * cells >= grid.columns || row * cells >= grid.rows) return std::nullopt;
    std::optional<Tile> tile = zoom == finest_ ? read(column, row) : halve(zoom, column, row);
    if (tile) write(zoom, column, row, *tile);
    return tile;
  }

  std::optional<Tile> read(std::int64_t column, std::int64_t row) const {
    const GridGeometry& grid = dem_->geometry();
    const Window window{column * kSide, row * kSide, std::min(kSide, grid.columns - column * kSide),
                        std::min(kSide, grid.rows - row * kSide)};
    const HeightWindow heights = dem_->read(window);
    Tile tile(kSide, kSide, kNoData);
    bool any = false;
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c)
        if (const double height = heights(c, r); height != kNoHeight) {
          tile(c, r) = static_cast<float>(height);
          any = true;
        }
    return any ? std::optional(std::move(tile)) : std::nullopt;
  }

  std::optional<Tile> halve(int zoom, std::int64_t column, std::int64_t row) {
    std::optional<Tile> tile;
    for (const std::int64_t down : {0, 1})
      for (const std::int64_t right : {0, 1}) {
        const auto child = store(zoom + 1, 2 * column + right, 2 * row + down);
        if (!child) continue;
        if (!tile) tile.emplace(kSide, kSide, kNoData);
        for (std::int64_t r = 0; r < kSide; r += 2)
          for (std::int64_t c = 0; c < kSide; c += 2)
            (*tile)((right * kSide + c) / 2, (down * kSide + r) / 2) =
                mean_of({(*child)(c, r), (*child)(c + 1, r), (*child)(c, r + 1), (*child)(c + 1, r + 1)});
      }
    return tile;
  }

  void write(int zoom, std::int64_t column, std::int64_t row, const Tile& tile) {
    const std::vector<std::byte> tiff = float_tiff(tile);
    tile_.bind_all(zoom, column, row, std::span<const std::byte>(tiff));
    tile_.run();
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, sum = 0;
    int known = 0;
    for (const float cell : tile.cells()) {
      if (cell == kNoData) continue;
      const auto height = static_cast<double>(cell);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
      sum += height;
      ++known;
    }
    ancillary_.bind_all(database_->last_id(), lowest, highest, sum / known);
    ancillary_.run();
  }

  const DemSource* dem_;
  const sqlite::Database* database_;
  sqlite::Statement tile_, ancillary_;
  int finest_ = 0;
};

}  // namespace

void write_dem_coverage(const sqlite::Database& database, const DemSource& dem, std::int32_t srs_id,
                        std::string_view changed) {
  database.execute(sql_text("coverage"));
  Pyramid pyramid(database, dem);
  const GridGeometry& grid = dem.geometry();
  const Georeference& where = grid.where;
  const double left = where.x0 - where.dx / 2, top = where.y0 - where.dy / 2;
  const auto right = [&](std::int64_t columns) { return left + static_cast<double>(columns) * where.dx; };
  const auto bottom = [&](std::int64_t rows) { return top + static_cast<double>(rows) * where.dy; };
  const std::int64_t across = kSide << pyramid.finest();  // tiles may extend beyond the DEM

  sqlite::Statement contents = database.prepare(
      "INSERT INTO gpkg_contents VALUES ('dem', '2d-gridded-coverage', 'dem', 'Elevation model the map was "
      "made from',"
      "  ?, ?, ?, ?, ?, ?)");
  contents.bind_all(changed, left, bottom(grid.rows), right(grid.columns), top, std::int64_t{srs_id});
  contents.run();
  sqlite::Statement set = database.prepare("INSERT INTO gpkg_tile_matrix_set VALUES ('dem', ?, ?, ?, ?, ?)");
  set.bind_all(std::int64_t{srs_id}, left, bottom(across), right(across), top);
  set.run();
  sqlite::Statement matrix =
      database.prepare("INSERT INTO gpkg_tile_matrix VALUES ('dem', ?1, ?2, ?2, ?3, ?3, ?4, ?5)");
  for (int zoom = 0; zoom <= pyramid.finest(); ++zoom) {
    const double cells = std::ldexp(1.0, pyramid.finest() - zoom);
    matrix.bind_all(zoom, std::int64_t{1} << zoom, kSide, where.dx * cells, -where.dy * cells);
    matrix.run();
  }
  sqlite::Statement ancillary = database.prepare(
      "INSERT INTO gpkg_2d_gridded_coverage_ancillary (tile_matrix_set_name, datatype, precision, data_null, "
      "uom)"
      "  VALUES ('dem', 'float', NULL, ?, 'm')");
  ancillary.bind(1, static_cast<double>(kNoData));
  ancillary.run();
  pyramid.store_all();
}

}  // namespace waymark::geodb

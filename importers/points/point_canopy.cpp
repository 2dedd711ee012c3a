// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/error.hpp"
#include "importers/points/canopy.hpp"
#include "importers/points/canopy_terrain.hpp"
#include "importers/points/las_catalogue.hpp"
#include "importers/points/point_checks.hpp"
#include "importers/points/recent_blocks.hpp"
#include "pipeline/forest/canopy_model.hpp"
#include "pipeline/forest/ground_filter.hpp"

namespace waymark::importers {
namespace {

constexpr std::int64_t kBlock = 256;  // cells; blocks lie on the grid, so no tiling changes a height
constexpr double kHalo = 20;          // metres of points around a block
constexpr double kGroundHalo = 3;     // squares of the ground filter around a block for finding the ground
// Memory of the points of a block, in units of --memory: surveys stay far below it.
constexpr std::int64_t kMemoryTimes = 4;
// Cells of the grid: the work is bounded by the size of the input. A survey has .01 to 20 cells per point.
constexpr double kMinCells = 1e8, kCellsPerPoint = 2000;

class PointCanopy final : public ImportedCanopy {
 public:
  explicit PointCanopy(const CanopyImport& import)
      : import_(import), catalogue_(import.las, import.memory_bytes / 2) {
    name_ = import.name.empty() ? std::filesystem::path(import.las[0]).filename().string() : import.name;
    check_points();
    grid_.where.crs = crs_of_points(catalogue_.headers(), import.crs, catalogue_.box(), warnings_);
    const Crs& crs = grid_.where.crs;
    if (crs.kind() == CrsKind::geographic)
      throw Error(ErrorCode::input,
                  fmt::format("the points are in degrees ({}), but trees are found in metres", crs.id()),
                  import.las[0], "reproject them into a projected CRS first (las2las -target_utm, pdal)");
    unit_ = crs.metres_per_unit();
    set_height_unit();
    lay_grid();
    if (!import.dtm.empty())
      open_terrain();
    else if (catalogue_.ground_points() == 0)
      check_density(catalogue_, unit_, import.las[0], warnings_);
    read_area();
  }

  const GridGeometry& geometry() const override { return grid_; }
  const std::string& name() const override { return name_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  const CanopyImport& import() const override { return import_; }
  DemHandle terrain() const override { return terrain_.dem(); }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }

  Grid<float> read(const Window& window) const override {
    Grid<float> heights(window.columns, window.rows, kNoCanopy);
    const Window all{0, 0, grid_.columns, grid_.rows};
    for (std::int64_t r = std::max<std::int64_t>(0, window.row); r < std::min(window.end_row(), all.rows);) {
      const std::int64_t block_row = r / kBlock,
                         next_row = std::min({(block_row + 1) * kBlock, window.end_row(), all.rows});
      for (std::int64_t c = std::max<std::int64_t>(0, window.column);
           c < std::min(window.end_column(), all.columns);) {
        const std::int64_t block_column = c / kBlock;
        const std::int64_t next = std::min({(block_column + 1) * kBlock, window.end_column(), all.columns});
        const auto block = block_at(block_column, block_row);
        for (std::int64_t j = r; j < next_row; ++j)
          for (std::int64_t i = c; i < next; ++i) {
            const float h = block->heights(i - block_column * kBlock, j - block_row * kBlock);
            if (!std::isnan(h)) heights(i - window.column, j - window.row) = std::max(h, 0.0F);
          }
        c = next;
      }
      r = next_row;
    }
    return heights;
  }

  double ground_elevation(std::int64_t column, std::int64_t row) const override {
    if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return std::nan("");
    return static_cast<double>(
        block_at(column / kBlock, row / kBlock)->ground(column % kBlock, row % kBlock));
  }

  Grid<float> ground(const Window& window) const override {
    if (terrain_.is_open()) return terrain_.at(window);
    Grid<float> ground(window.columns, window.rows, std::nanf(""));
    const std::int64_t first_row = std::max<std::int64_t>(0, window.row),
                       end_row = std::min(window.end_row(), grid_.rows),
                       first_column = std::max<std::int64_t>(0, window.column),
                       end_column = std::min(window.end_column(), grid_.columns);
    for (std::int64_t block_row = first_row / kBlock; block_row * kBlock < end_row; ++block_row)
      for (std::int64_t block_column = first_column / kBlock; block_column * kBlock < end_column;
           ++block_column) {
        const auto block = ground_at(block_column, block_row);
        for (std::int64_t r = std::max(first_row, block_row * kBlock);
             r < std::min(end_row, (block_row + 1) * kBlock); ++r)
          for (std::int64_t c = std::max(first_column, block_column * kBlock);
               c < std::min(end_column, (block_column + 1) * kBlock); ++c)
            ground(c - window.column, r - window.row) =
                (*block)(c - block_column * kBlock, r - block_row * kBlock);
      }
    return ground;
  }

  void visit_surface(const Window& window,
                     const std::function<void(const SurfacePoint&)>& use) const override {
    const Window around{std::max<std::int64_t>(0, window.column - 1),
                        std::max<std::int64_t>(0, window.row - 1), 0, 0};
    const std::int64_t columns = std::min(window.end_column() + 1, grid_.columns) - around.column,
                       rows = std::min(window.end_row() + 1, grid_.rows) - around.row;
    if (columns <= 0 || rows <= 0) return;
    const Grid<float> below = ground({around.column, around.row, columns, rows});
    const Georeference& where = grid_.where;
    const double cell_x = where.dx * unit_, cell_y = -where.dy * unit_;
    const auto edge = [](std::int64_t k) { return static_cast<double>(k) - 0.6; };
    catalogue_.visit({where.x(edge(window.column)), where.y(edge(window.end_row() + 1)),
                      where.x(edge(window.end_column() + 1)), where.y(edge(window.row))},
                     [&](const LasPoint& p) {
                       const double x = (p.x - where.x0) * unit_, y = (p.y - where.y0) * unit_;
                       const double column = x / cell_x, row = -y / cell_y;
                       if (!window.contains(static_cast<std::int64_t>(std::floor(column + 0.5)),
                                            static_cast<std::int64_t>(std::floor(row + 0.5))))
                         return;
                       const double z = p.z * height_unit_;
                       const double height =
                           z - between_cells(below, column - static_cast<double>(around.column),
                                             row - static_cast<double>(around.row));
                       if (std::isnan(height)) return;
                       const bool numbered = p.return_number > 0;
                       use({.x = x,
                            .y = y,
                            .z = z,
                            .height = static_cast<float>(height),
                            .number = p.return_number,
                            .of = numbered ? p.return_count : std::uint8_t{0},
                            .classification = p.classification});
                     });
  }

  double point_density() const override { return 1 / (spacing_ * spacing_); }

 private:
  /// Returns the bilinear value between cells, or that of the nearest ones at the edges.
  static double between_cells(const Grid<float>& values, double column, double row) {
    const double c = std::clamp(column, 0.0, static_cast<double>(values.columns() - 1)),
                 r = std::clamp(row, 0.0, static_cast<double>(values.rows() - 1));
    const auto i = static_cast<std::int64_t>(c), j = static_cast<std::int64_t>(r);
    const std::int64_t i2 = std::min(i + 1, values.columns() - 1), j2 = std::min(j + 1, values.rows() - 1);
    const double u = c - static_cast<double>(i), v = r - static_cast<double>(j);
    const auto at = [&](std::int64_t k, std::int64_t l) { return static_cast<double>(values(k, l)); };
    return (1 - v) * ((1 - u) * at(i, j) + u * at(i2, j)) + v * ((1 - u) * at(i, j2) + u * at(i2, j2));
  }

  void check_points() {
    const auto out = catalogue_.excluded();
    if (catalogue_.points() == 0)
      throw Error(ErrorCode::input,
                  out > 0 ? fmt::format("all {} points are noise (classes 7 and 18) or withheld", out)
                          : "the files hold no points",
                  import_.las[0], "check that they are the right ones");
    if (out > 0)
      warnings_.push_back(fmt::format("{}: {}{} points are noise or withheld and are skipped", import_.las[0],
                                      catalogue_.all_read() ? "" : "at least ", out));
  }

  void open_terrain() {
    CanopyImport terrain = import_;
    terrain.memory_bytes /= 4;
    terrain_ = CanopyTerrain(terrain, grid_, warnings_);
    if (!terrain_.covers_surface())
      warnings_.push_back(import_.dtm[0] +
                          ": the terrain model does not cover all points: where it ends, no heights are "
                          "known and no trees are found");
    if (import_.inspect)
      compare_with_terrain({catalogue_, terrain_, grid_, unit_, height_unit_}, import_.dtm[0], warnings_);
  }

  void set_height_unit() {
    const LasHeader& header = catalogue_.headers()[0];
    height_unit_ = header.metres_per_height > 0 ? header.metres_per_height : unit_;
    if (std::abs(height_unit_ - 1) > 1e-9)
      warnings_.push_back(fmt::format("{}: heights are in feet{}, and are turned into metres", header.path,
                                      header.metres_per_height > 0 ? "" : ", as the CRS is"));
  }

  void lay_grid() {
    const LasBox& box = catalogue_.box();
    const double area = (box.right - box.left) * (box.high - box.low) * unit_ * unit_;
    const double density = static_cast<double>(catalogue_.first_returns()) / std::max(area, 1.0);
    spacing_ = 1 / std::sqrt(std::max(density, 1e-4));
    double cell = import_.resolution;
    if (!(cell > 0))
      for (const double usual : {0.25, 0.5, 1.0, 2.0}) {
        cell = usual;
        if (usual >= spacing_) break;
      }
    const double step = cell / unit_;
    grid_.where.dx = step, grid_.where.dy = -step;
    const double left = std::floor(box.left / step), top = std::ceil(box.high / step);
    grid_.where.x0 = (left + 0.5) * step, grid_.where.y0 = (top - 0.5) * step;
    const double columns = std::floor(box.right / step) - left + 1, rows = top - std::floor(box.low / step);
    const double max_cells = std::max(kMinCells, kCellsPerPoint * static_cast<double>(catalogue_.points()));
    if (!(columns * rows < std::min(max_cells, 1e11)))
      throw Error(ErrorCode::input,
                  fmt::format("{} points lie {:.3g} x {:.3g} m apart, which are {:.3g} cells of {:g} m",
                              catalogue_.points(), columns * cell, rows * cell, columns * rows, cell),
                  import_.las[0],
                  "a header with a wrong scale or offset, a wild point, or files of different areas?");
    grid_.columns = std::max<std::int64_t>(1, static_cast<std::int64_t>(columns));
    grid_.rows = std::max<std::int64_t>(1, static_cast<std::int64_t>(rows));
    if (spacing_ > 1.5 * cell && import_.resolution > 0)
      warnings_.push_back(
          fmt::format("{:.2g} first returns per m2 are few for cells of {:g} m", density, cell));
  }

  std::shared_ptr<const pipeline::CanopyBlock> block_at(std::int64_t column, std::int64_t row) const {
    return blocks_.at(column, row, [&] { return compute_block(column, row); });
  }

  std::shared_ptr<const Grid<float>> ground_at(std::int64_t column, std::int64_t row) const {
    return grounds_.at(column, row, [&] { return compute_ground(column, row); });
  }

  /// Returns the ground of a block, as compute_block() has it.
  Grid<float> compute_ground(std::int64_t column, std::int64_t row) const {
    const BlockPoints points = read_block(column, row, false);
    return pipeline::ground_grid(points.all.ground, points.frame);
  }

  pipeline::CanopyBlock compute_block(std::int64_t column, std::int64_t row) const {
    BlockPoints points = read_block(column, row, true);
    if (terrain_.is_open()) {
      constexpr std::int64_t margin = pipeline::kTerrainMargin;
      const Grid<float> terrain = terrain_.at(
          {column * kBlock - margin, row * kBlock - margin, kBlock + 2 * margin, kBlock + 2 * margin});
      return pipeline::canopy_block(points.all.surface, terrain, points.frame, spacing_);
    }
    return pipeline::canopy_block(points.all, points.frame, spacing_);
  }

  struct BlockPoints {
    pipeline::CellFrame frame;
    pipeline::LaserPoints all;
  };

  /// Reads the points in and around a block and finds those of the ground; without `surface` those only.
  BlockPoints read_block(std::int64_t column, std::int64_t row, bool surface) const {
    const Georeference& where = grid_.where;
    const double first = static_cast<double>(column * kBlock), top = static_cast<double>(row * kBlock);
    BlockPoints read;
    read.frame = {
        where.x(first) * unit_, where.y(top) * unit_, where.dx * unit_, where.dy * unit_, kBlock, kBlock};
    const bool classified = terrain_.is_open() || catalogue_.ground_points() > 0;
    const double around = (classified ? kHalo : kGroundHalo * import_.ground_square) / unit_,
                 last = static_cast<double>(kBlock);
    pipeline::LaserPoints& points = read.all;
    const std::size_t max_points =
        static_cast<std::size_t>(std::max<std::int64_t>(1, kMemoryTimes * import_.memory_bytes) /
                                 std::int64_t{sizeof(Eigen::Vector3d)});
    catalogue_.visit({where.x(first) - around, where.y(top + last) - around, where.x(first + last) + around,
                      where.y(top) + around},
                     [&](const LasPoint& p) {
                       const Eigen::Vector3d at(p.x * unit_, p.y * unit_, p.z * height_unit_);
                       if (!terrain_.is_open() && (p.classification == 2 || !classified))
                         points.ground.push_back(at);
                       if (surface && is_first(p)) points.surface.push_back(at);
                       if (points.ground.size() + points.surface.size() > max_points)
                         refuse_density(column, row);
                     });
    if (!classified) {
      pipeline::GroundRules rules;
      rules.square = import_.ground_square;
      points.ground = pipeline::ground_returns(points.ground, rules);
    }
    return read;
  }

  /// Throws: the points of a block do not fit into the memory.
  [[noreturn]] void refuse_density(std::int64_t column, std::int64_t row) const {
    const double side = static_cast<double>(kBlock);
    throw Error(
        ErrorCode::input,
        fmt::format("more points lie near ({:.10g}, {:.10g}) than {} times --memory holds ({} MB)",
                    grid_.where.x((static_cast<double>(column) + 0.5) * side),
                    grid_.where.y((static_cast<double>(row) + 0.5) * side), kMemoryTimes,
                    kMemoryTimes * import_.memory_bytes / 1'000'000),
        import_.las[0],
        "a damaged or hostile file repeats points; thin a dense cloud (pdal sample), or pass a larger "
        "--memory");
  }

  CanopyImport import_;
  LasCatalogue catalogue_;
  GridGeometry grid_;
  CanopyTerrain terrain_;  // closed: the ground is that of the points
  double unit_ = 1, height_unit_ = 1, spacing_ = 1;
  std::vector<std::string> warnings_;
  std::string name_;
  mutable RecentBlocks<pipeline::CanopyBlock> blocks_;
  mutable RecentBlocks<Grid<float>> grounds_;
};

}  // namespace

std::shared_ptr<const ImportedCanopy> import_points(const CanopyImport& import) {
  return std::make_shared<const PointCanopy>(import);
}

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
// Heights for lines of sight against a lookup of each node by itself, and the cells that are read.
#include "workflows/planning/sight_terrain.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/error.hpp"

namespace waymark::test {
namespace {

using workflows::sight_terrain;

/// Waves of 40 m height; counts what is read.
class Waves final : public DemSource {
 public:
  explicit Waves(GridGeometry grid) : grid_(std::move(grid)) {}
  const GridGeometry& geometry() const override { return grid_; }
  NodataPolicy nodata_policy() const override { return NodataPolicy::unknown; }
  double at(std::int64_t column, std::int64_t row) const {
    if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return kNoHeight;
    return 500 + 40 * std::sin(0.11 * double(column)) * std::cos(0.07 * double(row));
  }
  HeightWindow read(const Window& window) const override {
    HeightWindow out(window.columns, window.rows);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c) out(c, r) = at(window.column + c, window.row + r);
    cells_read += window.columns * window.rows;
    return out;
  }
  std::vector<std::string> files() const override { return {"waves.tif"}; }

  mutable std::atomic<std::int64_t> cells_read{0};

 private:
  GridGeometry grid_;
};

GridGeometry grid_of(const Crs& crs, double x0, double y0, double cell, std::int64_t side) {
  GridGeometry grid;
  grid.columns = grid.rows = side;
  grid.where = {crs, x0, y0, cell, -cell};
  return grid;
}

TEST(SightTerrain, HeightsAreThoseOfTheDemAndCellsAreReadOnce) {
  const Crs utm = Crs::from_text("EPSG:32632"), degrees = Crs::from_text("EPSG:4326");
  const LocalFrame frame(utm, {{606000, 5194000, 0}});
  const struct {
    GridGeometry grid;
    Crs crs;
  } cases[] = {{grid_of(utm, 600000, 5200000, 30, 400), utm},
               {grid_of(degrees, 10.3, 47.0, 1.0 / 3600, 400), degrees}};
  for (const auto& [grid, crs] : cases) {
    const Waves dem(grid);
    const Terrain terrain =
        sight_terrain(dem, frame, {Eigen::Vector2d(-4000, -4000), Eigen::Vector2d(4000, 4000)});
    EXPECT_LT(dem.cells_read, 2 * grid.cells());
    const CrsTransform to_dem(utm, crs);
    double worst = 0;
    int known = 0;
    for (std::int64_t r = 0; r < terrain.heights().rows(); r += 7)
      for (std::int64_t c = 0; c < terrain.heights().columns(); c += 5) {
        const float height = terrain.heights()(c, r);
        if (!std::isfinite(height)) continue;
        ++known;
        // The point of the frame at that height lies above this point of the DEM.
        const double x = terrain.x0() + double(c) * terrain.step_x(),
                     y = terrain.y0() - double(r) * terrain.step_y();
        const double base = frame.crs_from_map_frame({{x, y, 0}}).xyz.z();
        const Eigen::Vector3d at = frame.crs_from_map_frame({{x, y, double(height) - base}}).xyz;
        const auto there = to_dem(at.x(), at.y());
        const double column = grid.where.column(there.x), row = grid.where.row(there.y);
        const auto c0 = std::int64_t(std::floor(column)), r0 = std::int64_t(std::floor(row));
        const double u = column - double(c0), v = row - double(r0);
        const double expected = (1 - v) * ((1 - u) * dem.at(c0, r0) + u * dem.at(c0 + 1, r0)) +
                                v * ((1 - u) * dem.at(c0, r0 + 1) + u * dem.at(c0 + 1, r0 + 1));
        if (std::isfinite(expected)) worst = std::max(worst, std::abs(expected - double(height)));
      }
    EXPECT_GT(known, 1000);
    EXPECT_LT(worst, 0.02) << crs.name();  // 4.4 m of height per cell, 1e-3 cells of position
  }
}

TEST(SightTerrain, NodesAreBoundedAndADemElsewhereIsNamed) {
  const Crs utm = Crs::from_text("EPSG:32632");
  const LocalFrame frame(utm, {{606000, 5194000, 0}});
  const Waves dem(grid_of(utm, 600000, 5200000, 30, 400));
  const Eigen::AlignedBox2d area(Eigen::Vector2d(-1e5, -1e5), Eigen::Vector2d(1e5, 1e5));
  const Terrain terrain = sight_terrain(dem, frame, area, {.max_nodes = 10000});
  EXPECT_LE(terrain.heights().columns() * terrain.heights().rows(), 10400);
  EXPECT_NEAR(terrain.step_x(), 120, 3) << "12 km in 100 nodes: only what the DEM covers";
  try {
    sight_terrain(dem, frame, {Eigen::Vector2d(5e4, 5e4), Eigen::Vector2d(6e4, 6e4)});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the DEM does not meet the area"), std::string::npos);
  }
}

TEST(SightTerrain, AListenerEndsIt) {
  const Crs utm = Crs::from_text("EPSG:32632");
  const Waves dem(grid_of(utm, 600000, 5200000, 30, 400));
  EXPECT_THROW(
      sight_terrain(dem, LocalFrame(utm, {{606000, 5194000, 0}}),
                    {Eigen::Vector2d(-4000, -4000), Eigen::Vector2d(4000, 4000)},
                    {.progress = [](const pipeline::Progress&) { throw std::runtime_error("enough"); }}),
      std::runtime_error);
}

}  // namespace
}  // namespace waymark::test

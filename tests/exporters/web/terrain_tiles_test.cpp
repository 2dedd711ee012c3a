// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/terrain_tiles.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/exporters/small_dem.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

double decoded(const Colour& c) {
  return c.red * 256.0 + c.green + c.blue / 256.0 - 32768;
}

/// A plane that rises eastwards and falls southwards, in metres of UTM zone 32.
Relief slope(std::int64_t columns, std::int64_t rows, double cell) {
  Relief relief{{500000, 5200000, 500000 + double(columns) * cell, 5200000 + double(rows) * cell},
                Grid<float>(columns, rows),
                cell,
                cell};
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c)
      relief.heights(c, r) = float(100 + 2 * double(c) - 0.5 * double(r));
  return relief;
}

TEST(Terrarium, StepsAreFourMillimetres) {
  for (const double height : {-8000.0, -0.001, 0.0, 0.125, 1234.567, 21229.0})
    EXPECT_NEAR(decoded(terrarium(height)), height, 1.0 / 512) << height;
  EXPECT_EQ(terrarium(0), (Colour{128, 0, 0}));
  EXPECT_EQ(terrarium(1e9), (Colour{255, 255, 255}));
}

TEST(HeightPyramid, LevelsAreMeansAndGapsAreFilledFromThem) {
  Grid<float> heights(3, 2, kNone);
  heights(0, 0) = 4;
  heights(1, 0) = 8;
  heights(2, 1) = 20;
  const HeightPyramid pyramid(heights);
  ASSERT_EQ(pyramid.levels(), 3);
  EXPECT_EQ(pyramid.level(1)(0, 0), 6);   // (4 + 8) / 2
  EXPECT_EQ(pyramid.level(1)(1, 0), 20);  // the odd column alone
  EXPECT_EQ(pyramid.level(2)(0, 0), 13);
  EXPECT_EQ(pyramid.level(0)(0, 1), 6);
  EXPECT_EQ(pyramid.level(0)(2, 0), 20);
  EXPECT_EQ(pyramid.level(0)(1, 0), 8);
  EXPECT_EQ(pyramid.at(0, 1, 0.5), 6);  // between the centres of 4 and 8
  EXPECT_EQ(pyramid.at(0, -5, 0), 4);   // beyond the edge
  EXPECT_EQ(pyramid.at(1, 2, 1), 13);   // between 6 and 20, in cells of level 0
}

TEST(TerrainTiles, EachPixelHasTheHeightOfItsPlace) {
  const Crs crs = Crs::from_text("EPSG:32632");
  const Relief relief = slope(300, 200, 10);
  const TerrainTiles terrain(crs, WebPlane::mercator, relief);
  const WebProjection projection(crs, WebPlane::mercator);
  // A pixel is between 0.7 and 1.4 cells wide.
  const double pixel =
      projection.world_width(projection.to_world(501500, 5201000)->y()) / std::ldexp(256, terrain.max_zoom());
  EXPECT_GT(pixel, 7);
  EXPECT_LT(pixel, 14.2);
  int inside = 0;
  for (const TileId& id : terrain.tiles()) {
    if (id.zoom < terrain.max_zoom()) continue;
    const Grid<float> heights = terrain.heights(id, projection);
    for (int row = 0; row < 256; row += 5)
      for (int column = 0; column < 256; column += 5) {
        const Eigen::Vector2d at =
            projection.from_world({std::ldexp(id.column + (column + 0.5) / 256, -id.zoom),
                                   std::ldexp(id.row + (row + 0.5) / 256, -id.zoom)});
        const double c = (at.x() - relief.extent.west) / 10 - 0.5,
                     r = (relief.extent.north - at.y()) / 10 - 0.5;
        if (!(c >= 0 && c <= 299 && r >= 0 && r <= 199)) continue;
        ++inside;
        // Positions are bilinear between 17 nodes: within a thousandth of a cell here.
        ASSERT_NEAR(heights(column, row), 100 + 2 * c - 0.5 * r, 0.01);
      }
  }
  // Every fifth pixel of the relief in both directions.
  EXPECT_NEAR(inside, 300 * 200 * 100 / std::pow(5 * pixel, 2), 60);
}

TEST(TerrainTiles, ZoomsAscendAndCoverTheRelief) {
  const Crs crs = Crs::from_text("EPSG:32632");
  const TerrainTiles terrain(crs, WebPlane::mercator, slope(300, 200, 10));
  const auto tiles = terrain.tiles();
  ASSERT_FALSE(tiles.empty());
  EXPECT_EQ(tiles.front(), (TileId{0, 0, 0}));
  for (std::size_t i = 1; i < tiles.size(); ++i) EXPECT_LT(pmtiles_id(tiles[i - 1]), pmtiles_id(tiles[i]));
  const Eigen::Vector2d corner = *WebProjection(crs, WebPlane::mercator).to_world(502999, 5200001);
  const int zoom = terrain.max_zoom();
  const TileId last{zoom, std::uint32_t(std::ldexp(corner.x(), zoom)),
                    std::uint32_t(std::ldexp(corner.y(), zoom))};
  EXPECT_EQ(std::ranges::count(tiles, last), 1);
}

TEST(TerrainTiles, TheOutlineIsThatOfTheRelief) {
  const Crs crs = Crs::from_text("EPSG:32632");
  const Relief relief = slope(300, 200, 10);
  const TerrainTiles terrain(crs, WebPlane::mercator, relief);
  const WebProjection projection(crs, WebPlane::mercator);
  double area = 0;
  const auto& outline = terrain.outline();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d at = projection.from_world(outline[i]);
    const double to_edge =
        std::min({std::abs(at.x() - relief.extent.west), std::abs(at.x() - relief.extent.east),
                  std::abs(at.y() - relief.extent.south), std::abs(at.y() - relief.extent.north)});
    EXPECT_LT(to_edge, 0.01);
    const Eigen::Vector2d next = projection.from_world(outline[(i + 1) % outline.size()]);
    area += (at.x() * next.y() - next.x() * at.y()) / 2;
    EXPECT_TRUE(outline[i].x() >= terrain.bounds().west && outline[i].x() <= terrain.bounds().east);
    EXPECT_TRUE(outline[i].y() >= terrain.bounds().north && outline[i].y() <= terrain.bounds().south);
  }
  EXPECT_NEAR(area, 3000 * 2000, 1);  // positive: against the clock
}

TEST(TerrainTiles, AnOutlineAcrossTheAntimeridianIsWhole) {
  const Crs mars = Crs::from_text("IAU_2015:49900");
  Relief relief{{177, -20, 183, -16}, Grid<float>(60, 40, 1.0F), 6000, 6000};
  const TerrainTiles terrain(mars, WebPlane::mercator, relief);
  EXPECT_NEAR(terrain.bounds().east - terrain.bounds().west, 6 / 360.0, 1e-9);
  for (std::size_t i = 1; i < terrain.outline().size(); ++i)
    EXPECT_LT((terrain.outline()[i] - terrain.outline()[i - 1]).norm(), 0.001);
  EXPECT_GT(terrain.tiles().size(), std::size_t(terrain.max_zoom()));
}

TEST(TerrainTiles, AGlobalModelHasNoSeamAtTheAntimeridian) {
  Relief relief{{-180, -90, 180, 90}, Grid<float>(720, 360), 30000, 30000};
  for (std::int64_t r = 0; r < 360; ++r)
    for (std::int64_t c = 0; c < 720; ++c)
      relief.heights(c, r) = float(1000 * std::cos((double(c) + 0.5) / 720 * 2 * std::numbers::pi));
  const Crs moon = Crs::from_text("IAU_2015:30100");
  const TerrainTiles terrain(moon, WebPlane::mercator, relief);
  const WebProjection projection(moon, WebPlane::mercator);
  EXPECT_EQ(std::ranges::count_if(terrain.tiles(), [](const TileId& id) { return id.zoom == 1; }), 4);
  for (const TileId& id : {TileId{0, 0, 0}, TileId{1, 0, 1}, TileId{1, 1, 0}}) {
    const Grid<float> heights = terrain.heights(id, projection);
    for (const int column : {0, 1, 128, 254, 255}) {
      const double turn = std::ldexp(id.column + (column + 0.5) / 256, -id.zoom) * 2 * std::numbers::pi;
      EXPECT_NEAR(heights(column, 100), 1000 * std::cos(turn), 3) << id.zoom << " " << column;
    }
  }
}

TEST(TerrainTiles, APictureHoldsTheHeights) {
  const TemporaryFolder folder;
  write_small_dem(folder / "dem.tif", 10, 46, 0.001);
  const Crs crs = Crs::from_text("EPSG:4326");
  const std::vector<std::string> dem{(folder / "dem.tif").string()};
  EXPECT_EQ(relief_pixels(dem, crs, 10, 4096), 100);
  EXPECT_EQ(relief_pixels(dem, crs, 10, 64), 64);
  EXPECT_EQ(relief_pixels({"missing.tif"}, crs, 10, 64), 0);
  const TerrainTiles terrain(crs, WebPlane::mercator, *read_relief(dem, crs, 10, 100));
  const WebProjection projection(crs, WebPlane::mercator);
  const TileId id = terrain.tiles().back();
  const Grid<float> heights = terrain.heights(id, projection);
  const std::string png = terrain.tile(id, projection);
  VSIFCloseL(VSIFileFromMemBuffer("/vsimem/tile.png", reinterpret_cast<GByte*>(const_cast<char*>(png.data())),
                                  png.size(), FALSE));
  {
    const GDALDatasetUniquePtr picture(GDALDataset::Open("/vsimem/tile.png"));
    ASSERT_TRUE(picture);
    ASSERT_EQ(picture->GetRasterCount(), 3);
    std::vector<std::uint8_t> rgb(3 * 256 * 256);
    ASSERT_EQ(picture->RasterIO(GF_Read, 0, 0, 256, 256, rgb.data(), 256, 256, GDT_Byte, 3, nullptr, 3,
                                3 * 256, 1, nullptr),
              CE_None);
    for (std::size_t i = 0; i < 256 * 256; ++i)
      ASSERT_NEAR(decoded({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}), heights.cells()[i], 1.0 / 500);
  }
  VSIUnlink("/vsimem/tile.png");
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "exporters/report/base64.hpp"
#include "exporters/report/relief_picture.hpp"
#include "exporters/report/relief_source.hpp"
#include "tests/exporters/small_dem.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

const Crs kDegrees = Crs::from_text("EPSG:4326");

TEST(ReadRelief, HasThePixelsAndProportionsOfTheGround) {
  const test::TemporaryFolder folder;
  test::write_small_dem(folder / "dem.tif", 10, 60.05,
                        0.001);  // at 60 N a degree east is half a degree north
  const auto relief = read_relief({(folder / "dem.tif").string()}, kDegrees, 10, 50);
  ASSERT_TRUE(relief);
  EXPECT_EQ(relief->heights.rows(), 50);
  EXPECT_EQ(relief->heights.columns(), 25);
  EXPECT_NEAR(relief->heights(12, 25), 990, 10);
  EXPECT_NEAR(relief->cell_y, 0.002 * 111195, 1);
}

TEST(ReadRelief, JoinsFilesAndKeepsVoids) {
  const test::TemporaryFolder folder;
  test::write_small_dem(folder / "a.tif", 10, 0.05, 0.001);
  test::write_small_dem(folder / "b.tif", 10.1, 0.05, 0.001);
  const auto relief = read_relief({(folder / "a.tif").string(), "missing.tif", (folder / "b.tif").string()},
                                  kDegrees, 10, 200);
  ASSERT_TRUE(relief);
  EXPECT_EQ(relief->heights.columns(), 200);
  EXPECT_TRUE(std::isnan(relief->heights(0, 0)));
  EXPECT_TRUE(std::isnan(relief->heights(100, 0)));
  EXPECT_EQ(relief->heights(49, 49), relief->heights(149, 49));
}

TEST(ReadRelief, MovesFilesByWholeTurnsToTheMap) {
  const test::TemporaryFolder folder;
  test::write_small_dem(folder / "east.tif", 179.9, 0.05, 0.001);
  test::write_small_dem(folder / "west.tif", -180, 0.05, 0.001);
  const auto relief =
      read_relief({(folder / "east.tif").string(), (folder / "west.tif").string()}, kDegrees, 180, 100);
  ASSERT_TRUE(relief);
  EXPECT_NEAR(relief->extent.width(), 0.2, 1e-9);
}

TEST(ReadRelief, IsNothingWithoutADem) {
  EXPECT_FALSE(read_relief({"missing.tif", "/etc/hostname"}, kDegrees, 0, 100));
}

/// A ridge from north to south: rising to the middle column, then falling.
Relief ridge() {
  Relief relief{{0, 0, 9, 9}, Grid<float>(9, 9, 0), 1, 1};
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column)
      relief.heights(column, row) = 100 - 10 * std::abs(static_cast<float>(column) - 4);
  return relief;
}

int lightness(const Colour& colour) {
  return colour.red + colour.green + colour.blue;
}

TEST(Shade, LightComesFromTheNorthWest) {
  const Relief relief = ridge();
  const Grid<Colour> picture = shade(relief, hypsometric_tint(relief, mars()));
  EXPECT_GT(lightness(picture(2, 4)), lightness(picture(6, 4)) + 60);
}

TEST(Shade, VoidsAreTransparent) {
  Relief relief = ridge();
  relief.heights(0, 0) = NAN;
  const Grid<Colour> picture = shade(relief, hypsometric_tint(relief, moon()));
  EXPECT_EQ(picture(0, 0).alpha, 0);
  EXPECT_EQ(picture(1, 0).alpha, 255);
}

TEST(Tint, OnlyEarthHasWater) {
  Relief relief = ridge();
  relief.heights(0, 0) = -50;
  const Colour sea = hypsometric_tint(relief, earth())(-10), mare = hypsometric_tint(relief, moon())(-10);
  EXPECT_GT(sea.blue, sea.red + 20);
  EXPECT_NEAR(mare.blue, mare.red, 10);
}

TEST(Tint, FlatGroundHasAColour) {
  Relief relief{{0, 0, 2, 2}, Grid<float>(2, 2, 7), 1, 1};
  EXPECT_EQ(shade(relief, hypsometric_tint(relief, mars()))(0, 0).alpha, 255);
}

TEST(Png, StartsAsPngAndLeavesNothingInMemory) {
  const std::string png = encode_png(Grid<Colour>(3, 2, {1, 2, 3, 255}));
  EXPECT_EQ(png.substr(1, 3), "PNG");
}

TEST(Base64, MatchesRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/error.hpp"
#include "geo/dem_source.hpp"
#include "importers/points/canopy.hpp"
#include "importers/points/canopy_codec.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

RasterFile raster(const std::string& name, const std::function<double(double, double)>& height,
                  std::int64_t side = 40, double cell = 1) {
  RasterFile file{.path = "/vsimem/" + name + ".tif", .cells = Grid<double>(side, side), .type = GDT_Float32};
  file.transform = GeoTransform{500000, cell, 0, 5000000, 0, -cell};
  for (std::int64_t r = 0; r < side; ++r)
    for (std::int64_t c = 0; c < side; ++c)
      file.cells(c, r) = height((static_cast<double>(c) + 0.5) * cell, (static_cast<double>(r) + 0.5) * cell);
  return file;
}

std::string refusal_of_canopy(const importers::CanopyImport& import) {
  return message_of([&] { importers::import_canopy(import); });
}

TEST(Canopy, IsSurfaceLessTerrain) {
  const auto dsm = write_raster(raster("dsm", [](double x, double y) { return 500 + x + 0.5 * y + 12; }));
  const auto dtm = write_raster(raster("dtm", [](double x, double y) { return 500 + x + 0.5 * y; }));
  const auto canopy = importers::import_canopy({.dsm = {dsm}, .dtm = {dtm}});
  const Grid<float> heights = canopy->read({-1, 0, 42, 40});
  EXPECT_EQ(heights(0, 5), kNoCanopy);
  EXPECT_NEAR(heights(11, 5), 12, 1e-3);
  EXPECT_NEAR(canopy->ground_elevation(10, 5), 500 + 10.5 + 2.75, 1e-3);
  EXPECT_TRUE(canopy->warnings().empty());
  EXPECT_EQ(canopy->name(), "dsm.tif");
}

TEST(Canopy, TerrainOnAnotherGridIsInterpolated) {
  const auto dsm = write_raster(raster(
      "fine", [](double x, double y) { return 500 + x + 0.5 * y + 12; }, 40, 0.5));
  const auto dtm = write_raster(raster(
      "coarse", [](double x, double y) { return 500 + x + 0.5 * y; }, 20, 3));
  const auto canopy = importers::import_canopy({.dsm = {dsm}, .dtm = {dtm}});
  EXPECT_THAT(canopy->warnings(), Contains(HasSubstr("the terrain is interpolated")));
  EXPECT_NEAR(canopy->read({20, 20, 1, 1})(0, 0), 12, 1e-3);
}

TEST(Canopy, NegativeHeightsCountAsZeroAndHolesAsUnknown) {
  RasterFile chm = raster("chm", [](double x, double) { return x < 4 ? -3 : x > 36 ? 400 : 10; });
  chm.nodata = -9999;
  for (std::int64_t r = 0; r < 40; ++r) chm.cells(20, r) = chm.cells(21, r) = chm.cells(22, r) = kNoHeight;
  const auto canopy = importers::import_canopy({.chm = {write_raster(chm)}});
  const Grid<float> heights = canopy->read({0, 0, 40, 1});
  EXPECT_EQ(heights(0, 0), 0);
  EXPECT_EQ(heights(20, 0), kNoCanopy);
  EXPECT_EQ(heights(39, 0), kNoCanopy);
  EXPECT_THAT(canopy->warnings(),
              AllOf(Contains(HasSubstr("are negative, down to -3.0 m")),
                    Contains(HasSubstr("have no height")), Contains(HasSubstr("which no tree is"))));
}

TEST(Canopy, SaysWhatCannotBe) {
  const auto low = write_raster(raster("low", [](double, double) { return 500; }));
  const auto high = write_raster(raster("high", [](double x, double) { return 510 + x / 10; }));
  EXPECT_THAT(refusal_of_canopy({.dsm = {low}, .dtm = {high}}),
              AllOf(HasSubstr("the terrain lies above the surface, by up to 1"), HasSubstr("exchanged?")));
  EXPECT_THAT(refusal_of_canopy({.chm = {low}}),
              AllOf(HasSubstr("these are elevations"), HasSubstr("--dsm")));
  EXPECT_THAT(refusal_of_canopy({.dsm = {low}}), HasSubstr("--dtm"));
  EXPECT_THAT(refusal_of_canopy({.chm = {low}, .dtm = {low}}), HasSubstr("needs neither"));
  EXPECT_THAT(refusal_of_canopy({}), HasSubstr("no canopy is given"));
  RasterFile far = raster("far", [](double, double) { return 490; });
  far.transform = GeoTransform{600000, 1, 0, 5000000, 0, -1};
  EXPECT_THAT(refusal_of_canopy({.dsm = {high}, .dtm = {write_raster(far)}}), HasSubstr("do not overlap"));
  RasterFile other = raster("other", [](double, double) { return 490; });
  other.crs = "EPSG:32632";
  EXPECT_THAT(refusal_of_canopy({.dsm = {high}, .dtm = {write_raster(other)}}),
              AllOf(HasSubstr("EPSG:32633"), HasSubstr("EPSG:32632"), HasSubstr("gdalwarp")));
}

TEST(Canopy, DegreesAreRefused) {
  RasterFile degrees = raster("degrees", [](double, double) { return 10; });
  degrees.crs = "EPSG:4326";
  degrees.transform = centred_on(15, 45, 1e-5);
  EXPECT_THAT(refusal_of_canopy({.chm = {write_raster(degrees)}}),
              AllOf(HasSubstr("is in degrees (EPSG:4326)"), HasSubstr("gdalwarp")));
}

TEST(Canopy, FeetBecomeMetres) {
  RasterFile feet = raster("feet", [](double x, double) { return x < 5 ? 0 : 60; });
  feet.crs = "EPSG:2264";  // North Carolina, US survey feet
  const auto canopy = importers::import_canopy({.chm = {write_raster(feet)}});
  EXPECT_NEAR(canopy->read({20, 20, 1, 1})(0, 0), 60 * 0.3048006, 1e-3);
  EXPECT_THAT(canopy->warnings(), Contains(HasSubstr("heights are taken to be in the same unit")));
  feet.path = "/vsimem/told.tif", feet.unit = "m";
  EXPECT_NEAR(importers::import_canopy({.chm = {write_raster(feet)}})->read({20, 20, 1, 1})(0, 0), 60, 1e-4);
}

TEST(Canopy, TerrainOfFeetIsStoredInMetres) {
  RasterFile surface = raster("dsm_feet", [](double, double) { return 1060; }),
             ground = raster("dtm_feet", [](double, double) { return 1000; });
  surface.crs = ground.crs = "EPSG:2264";
  const auto canopy =
      importers::import_canopy({.dsm = {write_raster(surface)}, .dtm = {write_raster(ground)}});
  EXPECT_NEAR(canopy->read({20, 20, 1, 1})(0, 0), 60 * 0.3048006, 1e-3);
  EXPECT_NEAR(canopy->ground_elevation(20, 20), 304.8006, 1e-3);
  EXPECT_NEAR(canopy->terrain()->read({20, 20, 1, 1})(0, 0), 304.8006, 1e-3);
}

TEST(Canopy, WithoutCrsIsMetres) {
  RasterFile plain = raster("plain", [](double, double) { return 10; });
  plain.crs = "";
  const auto canopy = importers::import_canopy({.chm = {write_raster(plain)}});
  EXPECT_EQ(canopy->geometry().where.crs.kind(), CrsKind::local);
  EXPECT_THAT(canopy->warnings(), Contains(HasSubstr("taken as metres")));
}

TEST(Canopy, ForestTypesComeFromASecondRaster) {
  const auto chm = write_raster(raster("chm2", [](double, double) { return 10; }));
  const auto types = write_raster(raster(
      "types", [](double x, double) { return x < 20   ? 1
                                             : x < 40 ? 2
                                                      : 9; }, 10, 6));
  const auto canopy = importers::import_canopy({.chm = {chm}, .forest_type = types});
  const Grid<std::uint8_t> at = canopy->forest_types({0, 0, 40, 1});
  EXPECT_EQ(at(2, 0), 1);
  EXPECT_EQ(at(30, 0), 2);
}

TEST(Canopy, AreKeptAsRecipes) {
  const auto chm = write_raster(raster("chm3", [](double x, double) { return x / 4; }));
  const Canopies canopies{importers::import_canopy({.chm = {chm}})};
  const Canopies again = Codec<Canopies>::decode(Codec<Canopies>::encode(canopies));
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0]->read({0, 0, 40, 40}), canopies[0]->read({0, 0, 40, 40}));
}

TEST(Canopy, KeepsTheNameItIsGiven) {
  const auto chm = write_raster(raster("chm4", [](double x, double) { return x / 4; }));
  const Canopies canopies{importers::import_canopy({.chm = {chm}, .name = "2019/chm.tif"})};
  EXPECT_EQ(Codec<Canopies>::decode(Codec<Canopies>::encode(canopies))[0]->name(), "2019/chm.tif");
}

TEST(CommonGrid, PartsOfTilesCoverEverySurveyOnce) {
  RasterFile second = raster(
      "second", [](double, double) { return 10; }, 31, 0.7);
  second.transform = GeoTransform{499990.3, 0.7, 0, 5000004.1, 0, -0.7};
  const Canopies surveys{
      importers::import_canopy({.chm = {write_raster(raster("first", [](double, double) { return 10; }))}}),
      importers::import_canopy({.chm = {write_raster(second)}})};
  const GridGeometry common = common_grid(surveys);
  EXPECT_LE(common.where.x(-0.5), 499990.3 + 1e-6);
  for (const auto& survey : surveys) {
    Grid<int> owners(survey->geometry().columns, survey->geometry().rows, 0);
    for (std::int64_t row = 0; row < common.rows; row += 7)
      for (std::int64_t column = 0; column < common.columns; column += 7) {
        const Window part = tile_window(survey->geometry(), common,
                                        {column, row, std::min<std::int64_t>(7, common.columns - column),
                                         std::min<std::int64_t>(7, common.rows - row)});
        for (std::int64_t r = part.row; r < part.end_row(); ++r)
          for (std::int64_t c = part.column; c < part.end_column(); ++c) ++owners(c, r);
      }
    for (const int count : owners.cells()) ASSERT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

HeightWindow heights_of(const RasterFile& file) {
  return all_heights(*import_dem({.files = {write_raster(file)}}));
}

const Grid<double> kHills = dem_art("1 2 3 / 4 9 6 / 7 8 5");

TEST(ImportDem, ReadsOtherFormatsAlike) {
  const GDALDatasetH tiff = GDALOpen(write_raster({.cells = kHills}).c_str(), GA_ReadOnly);
  for (const auto& [driver, path] :
       {std::pair{"COG", "/vsimem/hills_cog.tif"}, {"AAIGrid", "/vsimem/hills.asc"}}) {
    GDALClose(GDALCreateCopy(GDALGetDriverByName(driver), path, tiff, 0, nullptr, nullptr, nullptr));
    EXPECT_EQ(all_heights(*import_dem({.files = {path}, .crs = "EPSG:32633"})), kHills) << driver;
  }
  GDALClose(tiff);
}

TEST(ImportDem, HeightsNoBodyHasAreNoHeights) {
  // 21229 m is Olympus Mons; the others are garbage, one of them an undeclared no-data value.
  Grid<double> cells = dem_art("1 2 3 21229 5 / 1 2 3 4 5");
  cells(2, 0) = 9e9;
  cells(0, 1) = -32768;
  const auto dem =
      import_dem({.files = {write_raster({.cells = cells, .type = GDT_Float32, .nodata = -9999})}});
  EXPECT_EQ(all_heights(*dem), dem_art("1 2 . 21229 5 / . 2 3 4 5"));
  const CellFaults faults = dem->faults({0, 0, 5, 2});
  EXPECT_EQ(faults.implausible, 2);
  EXPECT_FLOAT_EQ(static_cast<float>(faults.height), 9e9F);
  EXPECT_EQ(faults.column, 2);
  EXPECT_EQ(faults.row, 0);
  EXPECT_EQ(dem->faults({3, 0, 2, 2}).implausible, 0);
  const auto integers = import_dem({.files = {write_raster({.cells = dem_art("1 2 / -32768 4")})}});
  EXPECT_EQ(all_heights(*integers), dem_art("1 2 / . 4"));
  EXPECT_EQ(integers->faults({0, 0, 2, 2}).row, 1);
}

TEST(ImportDem, ReadsTheBandThatIsNamed) {
  const std::string file = write_raster({.cells = kHills, .bands = 3});
  EXPECT_EQ(all_heights(*import_dem({.files = {file}, .band = 2})), kHills);
  EXPECT_THAT(message_of([&] { import_dem({.files = {file}, .band = 4}); }),
              HasSubstr("there is no band 4: this file has 3"));
}

TEST(ImportDem, TakesUnitAndScaleFromTheUser) {
  const std::string feet = write_raster({.cells = dem_art("100 200"), .unit = "fathom"});
  EXPECT_NEAR(all_heights(*import_dem({.files = {feet}, .height_unit = "ft"}))(1, 0), 60.96, 1e-12);
  EXPECT_THAT(import_dem({.files = {feet}, .height_unit = "ft"})->warnings(), IsEmpty());
  EXPECT_EQ(all_heights(*import_dem({.files = {feet}, .height_unit = "m", .height_scale = 0.1}))(0, 0), 10);
  EXPECT_THAT(message_of([&] { import_dem({.files = {feet}, .height_unit = "cubit"}); }),
              HasSubstr("name one of m, km, dm, cm, mm, ft, us-ft"));
}

TEST(ImportDem, AreaOfInterestIsInAnyCrs) {
  const std::string area = write_text("area.geojson", R"({"type": "Polygon", "coordinates": [[[14.99, 36.14],
      [15.0005, 36.14], [15.0005, 36.15], [14.99, 36.15], [14.99, 36.14]]]})");
  const auto dem = import_dem({.files = {write_raster({.cells = kHills})}, .area = area});  // zone 33: 15 E
  EXPECT_TRUE(dem->in_area(500000, 4000000));
  EXPECT_FALSE(dem->in_area(500060, 4000000));
  EXPECT_TRUE(import_dem({.files = {write_raster({.cells = kHills})}})->in_area(500060, 4000000));
  const std::string none = write_text("none.geojson", R"({"type": "Point", "coordinates": [15, 36]})");
  EXPECT_THAT(message_of([&] { import_dem({.files = {write_raster({.cells = kHills})}, .area = none}); }),
              HasSubstr("holds no polygon"));
}

TEST(ImportDem, GivesTheCentresOfCells) {
  const auto dem = import_dem({.files = {write_raster({.cells = kHills})}});
  const GridGeometry& grid = dem->geometry();
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.rows, 3);
  EXPECT_EQ(grid.where.x0, 500015);
  EXPECT_EQ(grid.where.y0, 3999985);
  EXPECT_EQ(grid.where.dy, -30);
  EXPECT_EQ(grid.where.crs.id(), "EPSG:32633");
  EXPECT_FALSE(grid.wraps);
  EXPECT_EQ(all_heights(*dem), kHills);
  EXPECT_THAT(dem->warnings(), IsEmpty());
}

TEST(ImportDem, CellsThatArePointsLieWhereTheFileSays) {
  char point[] = "Point";
  const std::string path = write_raster({.path = "/vsimem/point.tif", .cells = kHills});
  {
    const auto dataset = GDALOpen(path.c_str(), GA_Update);
    GDALSetMetadataItem(dataset, "AREA_OR_POINT", point, nullptr);
    GDALClose(dataset);
  }
  // GDAL writes the tie point for the centre and reads it back as the corner: the same ground either way.
  EXPECT_EQ(import_dem({.files = {path}})->geometry().where.x0, 500015);
}

TEST(ImportDem, AppliesScaleOffsetAndUnit) {
  EXPECT_EQ(heights_of({.cells = dem_art("10 20"), .scale = 0.5, .offset = 100}), dem_art("105 110"));
  const auto feet = heights_of({.cells = dem_art("10 20"), .unit = "ft"});
  EXPECT_NEAR(feet(0, 0), 3.048, 1e-12);
  EXPECT_NEAR(feet(1, 0), 6.096, 1e-12);
}

TEST(ImportDem, WarnsOfAUnitItDoesNotKnow) {
  const auto dem = import_dem({.files = {write_raster({.cells = kHills, .unit = "furlong"})}});
  EXPECT_THAT(dem->warnings(), ElementsAre(HasSubstr("in 'furlong', an unknown unit; metres are assumed")));
}

TEST(ImportDem, WarnsOfHeightsWithoutAUnitInACrsOfFeet) {
  const RasterFile feet{.cells = kHills, .crs = "EPSG:2264"};
  const auto dem = import_dem({.files = {write_raster(feet)}});
  EXPECT_THAT(dem->warnings(), ElementsAre(HasSubstr("heights are taken to be in metres")));
  RasterFile named = feet;
  named.unit = "ft";
  EXPECT_THAT(import_dem({.files = {write_raster(named)}})->warnings(), IsEmpty());
  EXPECT_THAT(import_dem({.files = {write_raster(feet)}, .height_unit = "m"})->warnings(), IsEmpty());
}

// A shape map of the Moon, 1737400 m in radius. Its heights, as elevations: 10 and -20 m.
TEST(ImportDem, TakesTheRadiusOffDistancesFromTheCentre) {
  const RasterFile moon{.transform = GeoTransform{0, 1, 0, 10, 0, -1}, .crs = "IAU_2015:30100"};
  RasterFile by_offset = moon, by_height = moon;
  by_offset.cells = dem_art("20 -40");
  by_offset.scale = 0.5;
  by_offset.offset = 1737400;
  by_height.cells = dem_art("1737410 1737380");
  by_height.type = GDT_Float64;
  EXPECT_THAT(import_dem({.files = {write_raster(by_offset)}})->warnings(),
              ElementsAre(HasSubstr("heights are distances from the body's centre: the band's offset is "
                                    "1737400 m, the radius of Moon is 1737400 m; 1737400 m are subtracted")));
  EXPECT_EQ(heights_of(by_offset), dem_art("10 -20"));
  EXPECT_THAT(import_dem({.files = {write_raster(by_height)}})->warnings(),
              ElementsAre(HasSubstr("the first ones are 1737380 to 1737410 m")));
  EXPECT_EQ(heights_of(by_height), dem_art("10 -20"));
}

TEST(ImportDem, FindsDistancesFromTheCentreBehindVoids) {
  Grid<double> cells(64, 64, kNoHeight);
  cells(60, 60) = 1737900;
  cells(61, 60) = 1737401;
  const auto heights = heights_of({.cells = cells,
                                   .type = GDT_Float32,
                                   .transform = GeoTransform{0, 0.5, 0, 32, 0, -0.5},
                                   .crs = "IAU_2015:30100",
                                   .nodata = -1,
                                   .options = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"}});
  EXPECT_EQ(heights(60, 60), 500);
  EXPECT_EQ(heights(61, 60), 1);
  EXPECT_EQ(heights(0, 0), kNoHeight);
}

TEST(ImportDem, LeavesElevationsFarFromTheRadiusAlone) {
  const auto heights = dem_art("1600000 1737400");  // 8 % below: no shape of the Moon
  const auto file = write_raster({.cells = heights,
                                  .type = GDT_Float64,
                                  .transform = GeoTransform{0, 1, 0, 10, 0, -1},
                                  .crs = "IAU_2015:30100"});
  const CellFaults faults = import_dem({.files = {file}, .inspect = false})->faults({0, 0, 2, 1});
  EXPECT_EQ(faults.implausible, 2);
  EXPECT_EQ(faults.height, 1600000);
  const auto dem = import_dem({.files = {write_raster({.cells = kHills, .offset = 10000})}});
  EXPECT_THAT(dem->warnings(), IsEmpty());
}

TEST(ImportDem, KeepsEveryCellTypeExactly) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Int64,
                                  GDT_UInt64, GDT_Float32, GDT_Float64})
    EXPECT_EQ(heights_of({.cells = kHills, .type = type}), kHills) << GDALGetDataTypeName(type);
  EXPECT_EQ(heights_of({.cells = dem_art("65535 40000"), .type = GDT_UInt16, .scale = 0.25}),
            dem_art("16383.75 10000"));
  const auto fine = dem_art("0.1 8848.123456789");
  EXPECT_EQ(heights_of({.cells = fine, .type = GDT_Float64}), fine);
}

TEST(ImportDem, NoDataHasNoHeight) {
  const auto holed = dem_art("1 . / . 4");
  EXPECT_EQ(heights_of({.cells = holed, .nodata = -32768}), holed);
  EXPECT_EQ(heights_of({.cells = holed, .type = GDT_Float32, .nodata = -9999.9}), holed);
  EXPECT_EQ(heights_of({.cells = holed, .type = GDT_Float32, .nodata = std::nan("")}), holed);
  EXPECT_EQ(heights_of({.cells = holed, .type = GDT_Float32, .nodata = -3.4028234663852886e38}), holed);
  EXPECT_EQ(heights_of({.cells = holed, .type = GDT_Float64, .nodata = -3.4028234663852886e38}), holed);
}

TEST(ImportDem, NoDataThatTheTypeCannotHoldHidesNothing) {
  EXPECT_EQ(heights_of({.cells = dem_art("0 1"), .type = GDT_Byte, .nodata = -9999}), dem_art("0 1"));
}

TEST(ImportDem, NanAndInfinityHaveNoHeight) {
  Grid<double> odd = dem_art("1 2 3 4");
  odd(1, 0) = std::nan("");
  odd(2, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(heights_of({.cells = odd, .type = GDT_Float32}), dem_art("1 . . 4"));
  EXPECT_EQ(heights_of({.cells = odd, .type = GDT_Float64}), dem_art("1 . . 4"));
}

TEST(ImportDem, MaskedCellsHaveNoHeight) {
  for (const GDALDataType type : {GDT_Int16, GDT_Float32, GDT_Float64})
    EXPECT_EQ(heights_of({.cells = dem_art("1 2 / 3 4"), .type = type, .mask = dem_art("1 0 / 1 1")}),
              dem_art("1 . / 3 4"));
}

TEST(ImportDem, TurnsASouthUpFile) {
  const auto dem =
      import_dem({.files = {write_raster({.cells = dem_art("1 2 / 3 4 / 5 6"),
                                          .transform = GeoTransform{500000, 30, 0, 3999910, 0, 30}})}});
  EXPECT_EQ(all_heights(*dem), dem_art("5 6 / 3 4 / 1 2"));
  EXPECT_EQ(dem->geometry().where.y0, 3999985);
  EXPECT_EQ(dem->read({1, 1, 1, 2}), dem_art("4 / 2"));
}

TEST(ImportDem, HasNoHeightsOutside) {
  const auto dem = import_dem({.files = {write_raster({.cells = dem_art("1 2 / 3 4")})}});
  EXPECT_EQ(dem->read({-1, -1, 4, 4}), dem_art(". . . . / . 1 2 . / . 3 4 . / . . . ."));
  EXPECT_EQ(dem->read({10, 10, 2, 1}), dem_art(". ."));
}

TEST(ImportDem, ReadsOtherFormats) {
  const std::string grid = write_text("dem.asc",
                                      "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 50\ncellsize 0.5\n"
                                      "NODATA_value -9999\n1 2 3\n4 -9999 6\n");
  const auto dem = import_dem({.files = {grid}, .crs = "EPSG:4326"});
  EXPECT_EQ(all_heights(*dem), dem_art("1 2 3 / 4 . 6"));
  EXPECT_EQ(dem->geometry().where.x0, 10.25);
  EXPECT_EQ(dem->geometry().where.y0, 50.75);
}

TEST(ImportDem, ReadsAnArchiveWithoutUnpackingIt) {
  const std::string tif = write_raster({.path = "/vsimem/inside.tif", .cells = kHills});
  VSILFILE* zip = VSIFOpenL("/vsizip//vsimem/archive.zip/inside.tif", "wb");
  VSILFILE* plain = VSIFOpenL(tif.c_str(), "rb");
  std::string bytes(100000, '\0');
  bytes.resize(VSIFReadL(bytes.data(), 1, bytes.size(), plain));
  VSIFCloseL(plain);
  VSIFWriteL(bytes.data(), 1, bytes.size(), zip);
  VSIFCloseL(zip);
  EXPECT_EQ(all_heights(*import_dem({.files = {"/vsizip//vsimem/archive.zip/inside.tif"}})), kHills);
}

TEST(ImportDem, OneCellIsADem) {
  const auto dem = import_dem({.files = {write_raster({.cells = dem_art("7")})}});
  EXPECT_EQ(all_heights(*dem), dem_art("7"));
  EXPECT_THAT(dem->warnings(), ElementsAre(HasSubstr("every cell has the height 7 m")));
}

TEST(ImportDem, WarnsOfAConstantDem) {
  const auto dem = import_dem({.files = {write_raster({.cells = Grid<double>(5, 4, -3)})}});
  EXPECT_THAT(dem->warnings(), ElementsAre(HasSubstr("every cell has the height -3 m: there is no relief")));
}

TEST(ImportDem, TakesACrsInsteadOfTheFiles) {
  const std::string path = write_raster({.cells = kHills, .crs = ""});
  EXPECT_EQ(import_dem({.files = {path}, .crs = "EPSG:32611"})->geometry().where.crs.id(), "EPSG:32611");
  EXPECT_EQ(import_dem({.files = {path}, .crs = "local"})->geometry().where.crs.kind(), CrsKind::local);
}

TEST(ImportDem, WithoutATransformLocalCellsAreMetres) {
  const std::string path = write_raster({.cells = kHills, .transform = {}, .crs = ""});
  const auto dem = import_dem({.files = {path}, .crs = "local"});
  EXPECT_EQ(dem->geometry().where.dx, 1);
  EXPECT_EQ(dem->geometry().where.dy, -1);
  EXPECT_EQ(all_heights(*dem), kHills);
}

TEST(ImportDem, KeepsFeetOfTheGroundInTheCrs) {
  const auto dem = import_dem({.files = {write_raster({.cells = kHills, .crs = "EPSG:2263"})}});
  EXPECT_NEAR(dem->geometry().where.crs.metres_per_unit(), 0.3048006096, 1e-9);
  EXPECT_EQ(dem->geometry().where.dx, 30);
}

TEST(ImportDem, KeepsItsImportOptions) {
  const auto dem = import_dem({.files = {write_raster({.cells = kHills})},
                               .nodata = NodataPolicy::unknown,
                               .height_sd = Meters{2.5}});
  EXPECT_EQ(dem->nodata_policy(), NodataPolicy::unknown);
  EXPECT_EQ(dem->height_sd(), 2.5);
  EXPECT_THAT(dem->files(), ElementsAre("/vsimem/dem.tif"));
}

}  // namespace
}  // namespace waymark::test

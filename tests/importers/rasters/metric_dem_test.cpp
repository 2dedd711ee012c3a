// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/metric_dem.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "geo/dem_handle.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "tests/importers/raster_maker.hpp"
namespace waymark::test {
using namespace importers;
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

// A plane in longitude and latitude about 7 E, 60 N: cells of 0.0002 degrees, 11 m east and 22 m north.
double height_of(double lon, double lat) {
  return 100 + 20000 * (lon - 7) + 8000 * (lat - 60);
}

std::string sloping(const std::string& path, double hole_at = -1) {
  Grid<double> cells(120, 80);
  for (std::int64_t r = 0; r < 80; ++r)
    for (std::int64_t c = 0; c < 120; ++c)
      cells(c, r) = height_of(7 + 0.0002 * static_cast<double>(c), 60 - 0.0002 * static_cast<double>(r));
  if (hole_at >= 0) cells(static_cast<std::int64_t>(hole_at), 40) = kNoHeight;
  return write_raster({.path = path,
                       .cells = cells,
                       .type = GDT_Float64,
                       .transform = centred_on(7, 60, 0.0002),
                       .crs = "EPSG:4326",
                       .nodata = -9999});
}

TEST(MetricDem, HasTheHeightsOfTheDegreesInSquareCells) {
  const auto dem = import_dem({.files = {sloping("/vsimem/degrees.tif")}, .metric = true});
  const GridGeometry& grid = dem->geometry();
  ASSERT_EQ(grid.where.crs.kind(), CrsKind::projected);
  EXPECT_EQ(grid.where.crs.metres_per_unit(), 1);
  EXPECT_NEAR(grid.where.dx, 11.16, 0.02);  // 0.0002 degrees of longitude at 60 N
  EXPECT_EQ(grid.where.dx, -grid.where.dy);
  EXPECT_NEAR(static_cast<double>(grid.rows) * grid.where.dx, 79 * 22.28, 25);
  const HeightWindow whole = dem->read({0, 0, grid.columns, grid.rows});
  const CrsTransform to_degrees(grid.where.crs, Crs::from_text("EPSG:4326"));
  for (std::int64_t r = 3; r < grid.rows - 3; r += 7)
    for (std::int64_t c = 3; c < grid.columns - 3; c += 7) {
      const auto at = to_degrees(grid.where.x(static_cast<double>(c)), grid.where.y(static_cast<double>(r)));
      EXPECT_NEAR(whole(c, r), height_of(at.x, at.y), 1e-3);
    }
  const HeightWindow piece = dem->read({30, 20, 9, 5});  // a window is the same as the whole's
  for (std::int64_t r = 0; r < 5; ++r)
    for (std::int64_t c = 0; c < 9; ++c) EXPECT_NEAR(piece(c, r), whole(30 + c, 20 + r), 1e-9);
  EXPECT_THAT(dem->warnings(), Contains(HasSubstr("is in degrees; it is used in metres: +proj=tmerc")));
}

TEST(MetricDem, CellsBesideAHoleHaveNoHeight) {
  const auto dem = import_dem(
      {.files = {sloping("/vsimem/holed.tif", 60)}, .nodata = NodataPolicy::unknown, .metric = true});
  const GridGeometry& grid = dem->geometry();
  int missing = 0, beside = 0;
  const HeightWindow whole = dem->read({0, 0, grid.columns, grid.rows});
  for (std::int64_t r = 4; r < grid.rows - 4; ++r)
    for (std::int64_t c = 4; c < grid.columns - 4; ++c) {
      if (whole(c, r) != kNoHeight) continue;
      ++missing;
      beside += std::abs(static_cast<double>(c) - static_cast<double>(grid.columns) / 2) < 4 &&
                std::abs(static_cast<double>(r) - static_cast<double>(grid.rows) / 2) < 6;
    }
  EXPECT_GE(missing, 4);
  EXPECT_EQ(missing, beside);
}

TEST(MetricDem, MetresStayAsTheyAre) {
  const std::string file = write_raster({.path = "/vsimem/metres.tif", .cells = Grid<double>(9, 9, 5.0)});
  const auto dem = import_dem({.files = {file}, .metric = true});
  EXPECT_EQ(dem->geometry().where.crs.id(), "EPSG:32633");
  EXPECT_EQ(dem->geometry().columns, 9);
}

TEST(MetricDem, IsKeptInAWorkFolderAsSuch) {
  const DemHandle dem = import_dem({.files = {sloping("/vsimem/kept.tif")}, .metric = true});
  const DemHandle again = pipeline::Codec<DemHandle>::decode(pipeline::Codec<DemHandle>::encode(dem));
  EXPECT_TRUE(again->geometry().where.crs.same_as(dem->geometry().where.crs));
  EXPECT_EQ(again->geometry().columns, dem->geometry().columns);
}

TEST(MetricDem, RefusesHalfAPlanet) {
  const std::string file = write_raster({.path = "/vsimem/wide.tif",
                                         .cells = Grid<double>(90, 40, 5.0),
                                         .transform = centred_on(0, 40, 1.0),
                                         .crs = "EPSG:4326"});
  const std::string message =
      message_of([&] { import_dem({.files = {file}, .metric = true, .inspect = false}); });
  EXPECT_THAT(message, HasSubstr("too wide for a projection to metres"));
  EXPECT_THAT(message, HasSubstr("gdal_translate -projwin"));
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// The shared test data; skipped if it is not installed.
#include <gmock/gmock.h>

#include <algorithm>

#include "importers/rasters/dem.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RealDem : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!shared_dem("README.md")) GTEST_SKIP() << "the shared test data is not here";
  }
  static std::shared_ptr<const ImportedDem> import(const std::vector<std::string>& names) {
    DemImport wanted;
    for (const std::string& name : names) wanted.files.push_back(shared_dem(name).value());
    return import_dem(wanted);
  }
};

double highest(const DemSource& dem) {
  const HeightWindow heights = dem.read({0, 0, dem.geometry().columns, dem.geometry().rows});
  return std::ranges::max(heights.cells());
}

TEST_F(RealDem, SrtmTilesOverlapByOneSampleAndAgree) {
  const auto dem = import({"earth/N41E001.tif", "earth/N42E001.tif"});
  EXPECT_EQ(dem->geometry().columns, 1201);
  EXPECT_EQ(dem->geometry().rows, 2401);
  EXPECT_NEAR(dem->geometry().where.x0, 1, 1e-9);
  EXPECT_NEAR(dem->geometry().where.y0, 43, 1e-9);
  EXPECT_THAT(dem->warnings(), IsEmpty());
}

TEST_F(RealDem, AconcaguaIsTheTopOfItsTile) {
  const auto dem = import({"earth/S33W071.tif"});
  EXPECT_EQ(highest(*dem), 6929);
  EXPECT_EQ(dem->geometry().where.crs.id(), "EPSG:4326");
}

TEST_F(RealDem, MarsWrapsAndKeepsItsSphere) {
  const auto dem = import({"mars/mars_mola_4ppd.tif"});
  const GridGeometry& grid = dem->geometry();
  EXPECT_TRUE(grid.wraps && grid.north_pole && grid.south_pole);
  EXPECT_EQ(grid.where.x0, 0.125);
  EXPECT_EQ(grid.where.crs.body().name, "Mars");
  EXPECT_EQ(grid.where.crs.body().equatorial_radius, 3396190);
  EXPECT_EQ(highest(*dem), 21134);
  EXPECT_EQ(dem->read({-1, 300, 1, 1}), dem->read({1439, 300, 1, 1}));
}

// LOLA's shape map: its label gives 1737400 m as offset and 21008 / 2 = 10504 m as the highest elevation.
TEST_F(RealDem, TheShapeOfTheMoonBecomesElevations) {
  const std::string label = "../craters/catalogues/LDEM_4.LBL";
  if (!shared_dem(label)) GTEST_SKIP() << label << " is not here";
  const auto dem = import({label});
  EXPECT_THAT(dem->warnings(), ElementsAre(HasSubstr("1737400 m are subtracted")));
  EXPECT_EQ(highest(*dem), 10504);
}

TEST_F(RealDem, GaleCraterIsProjectedAndBelowTheDatum) {
  const auto dem = import({"mars/mmgis_missionDEM_gale_1m.tif"});
  EXPECT_EQ(dem->geometry().where.crs.kind(), CrsKind::projected);
  EXPECT_EQ(dem->geometry().where.x0, 8142406.5);
  EXPECT_FALSE(dem->geometry().wraps);
  EXPECT_LT(highest(*dem), 0);
}

TEST_F(RealDem, BigTujungaIsInUtm) {
  const auto dem = import({"earth/bigtujunga.tif"});
  EXPECT_EQ(dem->geometry().where.crs.id(), "EPSG:32611");
  const HeightWindow heights = dem->read({0, 0, 1197, 643});
  EXPECT_EQ(std::ranges::min(heights.cells()), 315)
      << "no cell is void, although the file names a no-data value";
  EXPECT_EQ(highest(*dem), 2295);
}

TEST_F(RealDem, LuxembourgIsRead) {
  EXPECT_EQ(highest(*import({"small/luxembourg.tif"})), 547);
}

}  // namespace
}  // namespace waymark::test

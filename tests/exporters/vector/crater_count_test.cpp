// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/crater_count.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "exporters/report/counting_area.hpp"
#include "exporters/report/size_frequency.hpp"
#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"
#include "tests/exporters/small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::content_of;
using test::error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two craters of 2 and 3 km on Mars; one image of 20 x 10 km in an equirectangular map.
geodb::MapContents mars_craters() {
  geodb::MapContents map;
  register_landmark_types(map.types);
  map.crs = Crs::from_text("+proj=eqc +lat_ts=0 +lon_0=0 +a=3396190 +b=3396190 +units=m +no_defs +type=crs");
  const TypeId id = map.types.id("crater");
  for (const auto& [x, radius] : {std::pair{1000.0, 1000.0}, {15000.0, 1500.0}, {50000.0, 700.0}}) {
    Landmark landmark;
    landmark.uid = "cr-" + std::to_string(static_cast<int>(x));
    landmark.type = id;
    landmark.position.xyz = {x, 5000, 0};
    landmark.features.resize(map.types[id].features.size());
    landmark.features[feature_index(map.types[id], "radius")] = {radius, 0, 1};
    landmark.quality = {1, 1, std::vector<std::optional<double>>(map.types[id].features.size())};
    map.landmarks.push_back(landmark);
  }
  geodb::ImageRecord image;
  image.name = "ctx.tif";
  image.footprint = {{{0, 0}, {20000, 0}, {20000, 10000}, {0, 10000}}};
  map.images = {image};
  map.run.version = "0.1.0";
  return map;
}

class CraterCount : public ::testing::Test {
 protected:
  test::TemporaryFolder folder;
  std::filesystem::path map = folder / "mars.gpkg";

  std::string exported(const std::string& name, const ExportOptions& options = {}) {
    summary = export_map(map, (folder / name).string(), options);
    return content_of(folder / name);
  }
  ExportSummary summary;
};

TEST_F(CraterCount, SccHasAxesOutlineAreaAndPlaces) {
  geodb::write_map(map, mars_craters());
  const std::string text = exported("mars.scc");
  EXPECT_THAT(text, AllOf(HasSubstr("a_axis_radius = 3396.19 <km>\n"),
                          HasSubstr("unit_boundary = {vertex,sub_area,tag,lon,lat\n"),
                          HasSubstr("1\t1\text\t"), HasSubstr("crater = {diam,lon,lat\n2\t")));
  const double degree = std::numbers::pi / 180 * 3396.19;  // kilometres
  std::istringstream row(text.substr(text.find("crater = {diam,lon,lat\n") + 23));
  double diameter = 0, lon = 0, lat = 0;
  row >> diameter >> lon >> lat;
  EXPECT_NEAR(diameter, 2, 1e-9);
  EXPECT_NEAR(lon, 1 / degree, 1e-9);
  EXPECT_NEAR(lat, 5 / degree, 1e-9);
  // 20 x 10 km at the equator, where an equirectangular map is true to a millionth
  const auto at = text.find("Total_area = ") + 13;
  EXPECT_NEAR(std::stod(text.substr(at)), 200, 2e-3);
  EXPECT_EQ(text.substr(at, 12).find_first_not_of("0123456789."),
            std::string::npos);  // craterstats reads no exponent
  EXPECT_THAT(summary.warnings, ElementsAre(HasSubstr("1 whose centre lies outside the counting area")));
}

TEST_F(CraterCount, DiamHasAreaAndDiameters) {
  geodb::write_map(map, mars_craters());
  const std::string text = exported("mars.diam");
  EXPECT_THAT(text, AllOf(::testing::StartsWith("area="), HasSubstr("\ncrater={diameter,fraction\n"),
                          ::testing::EndsWith("\n}\n")));
  EXPECT_THAT(text, AllOf(HasSubstr("\n2 1\n"), HasSubstr("\n3 1\n")));
}

TEST_F(CraterCount, OverlappingFootprintsCountOnce) {
  geodb::MapContents contents = mars_craters();
  contents.images.push_back(contents.images[0]);
  contents.images[1].name = "ctx2.tif";
  for (auto& corner : contents.images[1].footprint[0]) corner.x() += 10000;
  geodb::write_map(map, contents);
  const auto area = counting_area(geodb::MapStore::open(map));
  ASSERT_TRUE(area);
  EXPECT_NEAR(area->square_metres / 1e6, 300, 3e-3);
  EXPECT_EQ(area->source, "the footprints of 2 images together");
}

TEST_F(CraterCount, AreaMustBeKnownOrGiven) {
  geodb::MapContents contents = mars_craters();
  contents.images.clear();
  geodb::write_map(map, contents);
  EXPECT_THAT(
      error_of([&] { exported("mars.scc"); }),
      AllOf(HasSubstr("the area on which the craters were counted is not known"), HasSubstr("--area KM2")));
  EXPECT_THAT(exported("mars.diam", {.area_km2 = 123.5}), HasSubstr("area=123.5"));
  EXPECT_THAT(error_of([&] { exported("mars.diam", {.area_km2 = 123.5}); }), HasSubstr("exists already"));
  EXPECT_THAT(error_of([&] { exported("other.diam", {.area_km2 = -1}); }),
              HasSubstr("it must be larger than 0"));
}

TEST_F(CraterCount, OtherMapsAreRefused) {
  test::write_small_map(map);  // mountain tops
  EXPECT_THAT(error_of([&] { exported("x.diam"); }), HasSubstr("no craters to count"));
  geodb::MapContents local = mars_craters();
  local.crs = Crs::local();
  geodb::write_map(map, local);
  EXPECT_THAT(error_of([&] { exported("x.scc"); }), HasSubstr("the map is on no body"));
  EXPECT_THAT(exported("x.diam"), HasSubstr("area=200.000000000\n"));
}

TEST(CountingArea, KnownCellsOfADemInDegrees) {
  Relief relief;
  relief.extent = {0, -90, 360, 90};
  relief.heights = Grid<float>(36, 18, 0);
  relief.cell_x = relief.cell_y = 1;
  const Crs moon = Crs::from_text("IAU_2015:30100");
  const double sphere = 4 * std::numbers::pi * 1737400.0 * 1737400.0;
  EXPECT_NEAR(area_of(relief, moon) / sphere, 1, 1e-9);
  for (std::int64_t column = 0; column < 18; ++column)
    for (std::int64_t row = 0; row < 18; ++row) relief.heights(column, row) = std::nanf("");
  EXPECT_NEAR(area_of(relief, moon) / sphere, 0.5, 1e-9);
}

TEST(SizeFrequency, BinsGrowByTheRootOfTwoAndAccumulate) {
  const auto bins = size_bins({1000, 1200, 1500, 4000});
  ASSERT_EQ(bins.size(), 5u);  // 1000, 1414, 2000, 2828, 4000
  EXPECT_NEAR(bins[1].from, 1000 * std::numbers::sqrt2, 1e-9);
  EXPECT_EQ(bins[0].count, 2);
  EXPECT_EQ(bins[0].larger, 4);
  EXPECT_EQ(bins[1].larger, 2);
  EXPECT_EQ(bins[4].count, 1);
}

TEST(SizeFrequency, RIsFlatWhereNumbersFallWithTheCube) {
  // dN/dD = k / D^3: N in [a, b] = k/2 (1/a^2 - 1/b^2); R = D^3 N / (A dD) is the same for every bin
  std::vector<double> r;
  for (const double a : {1000.0, 2000.0, 8000.0}) {
    const double b = a * std::numbers::sqrt2, n = 5e12 * (1 / (a * a) - 1 / (b * b));
    r.push_back(relative_density({a, b, static_cast<std::int64_t>(n), 0}, 1e12));
  }
  EXPECT_NEAR(r[1] / r[0], 1, 1e-5);
  EXPECT_NEAR(r[2] / r[0], 1, 1e-4);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "geo/crs.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "core/error.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
namespace {

using ::testing::HasSubstr;

TEST(Crs, ReadsCodesOfEarthAndMars) {
  const Crs earth_crs = Crs::from_text("EPSG:4326");
  EXPECT_EQ(earth_crs.kind(), CrsKind::geographic);
  EXPECT_EQ(earth_crs.id(), "EPSG:4326");
  EXPECT_EQ(earth_crs.body(), earth());
  EXPECT_EQ(earth_crs.metres_per_unit(), 0);

  const Crs utm = Crs::from_text("EPSG:32611");
  EXPECT_EQ(utm.kind(), CrsKind::projected);
  EXPECT_EQ(utm.name(), "WGS 84 / UTM zone 11N");
  EXPECT_EQ(utm.metres_per_unit(), 1);

  const Crs mars_crs = Crs::from_text("IAU_2015:49910");
  EXPECT_EQ(mars_crs.body().name, "Mars");
  EXPECT_EQ(mars_crs.body().equatorial_radius, 3396190);
  EXPECT_EQ(mars_crs.id(), "IAU_2015:49910");
}

TEST(Crs, SurvivesItsOwnWkt) {
  for (const char* id : {"EPSG:4326", "EPSG:32611", "EPSG:2263", "IAU_2015:49900", "IAU_2015:30100"}) {
    const Crs crs = Crs::from_text(id);
    EXPECT_EQ(Crs::from_text(crs.wkt2()).id(), id);
    EXPECT_TRUE(Crs::from_text(crs.wkt1()).same_as(crs)) << id;
    EXPECT_EQ(crs.wkt2().find('\n'), std::string::npos);
  }
}

TEST(Crs, RecoversThePlanetaryCodeThatGeoTiffDrops) {
  std::string wkt = Crs::from_text("IAU_2015:49910").wkt2();
  for (auto id = wkt.find(",ID[\"IAU"); id != std::string::npos; id = wkt.find(",ID[\"IAU"))
    wkt.erase(id, wkt.find(']', id) + 1 - id);
  EXPECT_EQ(Crs::from_text(wkt).id(), "IAU_2015:49910");
}

/// As GDAL reads it from a GeoTIFF: about a pole, east is "north along the meridian of 90 degrees".
TEST(Crs, OfAPoleIsTheSameWhateverItsAxesAreCalled) {
  for (const auto& [code, pole] : {std::pair{"IAU_2015:49935", -90}, std::pair{"IAU_2015:49930", 90}}) {
    const Crs catalogue = Crs::from_text(code);
    std::string text = catalogue.wkt2();
    const auto replace = [&](const std::string& part, const std::string& by) {
      const auto at = text.find(part);
      ASSERT_NE(at, std::string::npos) << text;
      text.replace(at, part.size(), by);
    };
    const std::string to_pole = pole < 0 ? "north" : "south";
    const auto axis = [&](int meridian) {
      return to_pole + ",MERIDIAN[" + std::to_string(meridian) + ",ANGLEUNIT[\"degree\",0.0174532925199433]]";
    };
    replace("AXIS[\"(E)\",east", "AXIS[\"(E)\"," + axis(90));
    replace("AXIS[\"(N)\",north", "AXIS[\"(N)\"," + axis(pole < 0 ? 0 : 180));
    const auto id = text.rfind(",ID[");
    text.erase(id, text.size() - 1 - id);
    const Crs geotiff = Crs::from_text(text);
    EXPECT_EQ(geotiff.id(), code);
    EXPECT_TRUE(geotiff.same_as(catalogue));
    EXPECT_TRUE(catalogue.same_as(geotiff));
  }
  EXPECT_FALSE(Crs::from_text("IAU_2015:49935").same_as(Crs::from_text("IAU_2015:49930")));
  EXPECT_FALSE(Crs::from_text("EPSG:5513").same_as(Crs::from_text("EPSG:5514"))) << "one counts to the south";
}

TEST(Crs, PreservesAnUnknownDefinitionUnderItsName) {
  const Crs crs = Crs::from_text("+proj=eqc +R=1000000 +units=m +no_defs +type=crs");
  EXPECT_EQ(crs.authority(), "");
  EXPECT_EQ(crs.id(), crs.name());
  EXPECT_EQ(crs.body().equatorial_radius, 1e6);
}

TEST(Crs, PreservesFeet) {
  EXPECT_NEAR(Crs::from_text("EPSG:2263").metres_per_unit(), 1200.0 / 3937, 1e-15);
}

TEST(Crs, TakesTheHorizontalPart) {
  EXPECT_EQ(Crs::from_text("EPSG:4326+5773").id(), "EPSG:4326");
  EXPECT_EQ(Crs::from_text("EPSG:4979").kind(), CrsKind::geographic);
}

TEST(Crs, LocalIsOnNoBody) {
  EXPECT_EQ(Crs::local().kind(), CrsKind::local);
  EXPECT_EQ(Crs::local().body().name, "");
  EXPECT_EQ(Crs::from_text(Crs::local().wkt2()).kind(), CrsKind::local);
  EXPECT_THAT(message_of([] { geographic_crs(Crs::local()); }), HasSubstr("no longitude and latitude"));
}

TEST(Crs, SaysWhyItCannotUnderstand) {
  EXPECT_THAT(
      message_of([] { Crs::from_text("EPSG:999999"); }),
      ::testing::AllOf(HasSubstr("crs not found"), HasSubstr("EPSG:999999"), HasSubstr("give it as")));
  EXPECT_THAT(message_of([] { Crs::from_text("no such thing"); }), HasSubstr("cannot understand"));
  EXPECT_THAT(message_of([] { Crs::from_text("EPSG:4978"); }), HasSubstr("neither geographic nor projected"));
  EXPECT_THAT(message_of([] { Crs::from_text("EPSG:4807"); }), HasSubstr("in grad, not in degrees"));
}

TEST(Crs, ComparesByMeaning) {
  EXPECT_TRUE(Crs::from_text("EPSG:4326").same_as(Crs::from_text("OGC:CRS84")));
  EXPECT_FALSE(Crs::from_text("EPSG:32611").same_as(Crs::from_text("EPSG:32612")));
  EXPECT_FALSE(Crs::from_text("EPSG:4326").same_as(Crs::local()));
}

TEST(CrsTransform, PutsLongitudeAndEastingFirst) {
  const CrsTransform to_utm(Crs::from_text("EPSG:4326"), Crs::from_text("EPSG:32611"));
  const auto on_the_central_meridian = to_utm(-117, 0);
  EXPECT_NEAR(on_the_central_meridian.x, 500000, 1e-6);
  EXPECT_NEAR(on_the_central_meridian.y, 0, 1e-6);
}

TEST(CrsTransform, ComesBack) {
  const Crs utm = Crs::from_text("EPSG:32611");
  const CrsTransform there(geographic_crs(utm), utm), back(utm, geographic_crs(utm));
  std::vector<double> x{-118.2, -117.9, -117.1}, y{34.3, 34.1, 36.9};
  const auto lon = x, lat = y;
  there.apply(x, y);
  back.apply(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i], lon[i], 1e-9);
    EXPECT_NEAR(y[i], lat[i], 1e-9);
  }
}

TEST(CrsTransform, GivesNanWhereThereIsNoImage) {
  const CrsTransform to_mercator(Crs::from_text("EPSG:4326"), Crs::from_text("EPSG:3395"));
  const auto beyond = to_mercator(0, 95);
  EXPECT_TRUE(std::isnan(beyond.x) && std::isnan(beyond.y));
}

TEST(CrsTransform, RefusesAnotherBody) {
  const std::string message =
      message_of([] { CrsTransform(Crs::from_text("IAU_2015:49900"), Crs::from_text("EPSG:4326")); });
  EXPECT_THAT(message, HasSubstr("from IAU_2015:49900 to EPSG:4326: Mars is not Earth"));
  EXPECT_THAT(message_of([] { CrsTransform(Crs::local(), Crs::from_text("EPSG:4326")); }),
              HasSubstr("a local CRS is not Earth"));
}

TEST(CrsTransform, WorksInManyThreads) {
  std::vector<std::thread> threads;
  std::vector<double> eastings(8);
  for (std::size_t i = 0; i < eastings.size(); ++i)
    threads.emplace_back([&eastings, i] {
      eastings[i] = CrsTransform(Crs::from_text("EPSG:4326"), Crs::from_text("EPSG:32633"))(15, 45).x;
    });
  for (auto& thread : threads) thread.join();
  for (const double easting : eastings) EXPECT_NEAR(easting, 500000, 1e-6);
}

TEST(GeographicCrs, HasTheSameDatum) {
  EXPECT_EQ(geographic_crs(Crs::from_text("EPSG:32611")).id(), "EPSG:4326");
  EXPECT_EQ(geographic_crs(Crs::from_text("EPSG:2263")).id(), "EPSG:4269");
  EXPECT_EQ(geographic_crs(Crs::from_text("IAU_2015:49910")).id(), "IAU_2015:49900");
}

}  // namespace
}  // namespace waymark::test

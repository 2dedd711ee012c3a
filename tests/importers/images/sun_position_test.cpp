// SPDX-License-Identifier: Apache-2.0
#include "importers/images/sun_position.hpp"

#include <gmock/gmock.h>

#include "importers/images/image_labels.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::HasSubstr;

// Reda and Andreas, Solar Position Algorithm (NREL/TP-560-34302, 2008), table A5.1: elevation before
// refraction.
TEST(SunOnEarth, AgreesWithTheExampleOfSpa) {
  const Sun sun = sun_on_earth(*utc_seconds("2003-10-17T12:30:30-07:00"), -105.1786, 39.742476);
  EXPECT_NEAR(sun.elevation.value, 39.872046, 0.01);
  EXPECT_NEAR(sun.azimuth.value, 194.340241, 0.01);
}

TEST(SunOnEarth, StandsInTheZenithWhereItsDeclinationIs) {
  // 2020-06-20 21:44 UTC: the June solstice; the sun is over the tropic, at noon there.
  const Sun sun = sun_on_earth(*utc_seconds("2020-06-20T21:44:00Z"), -145.55, 23.4365);
  EXPECT_GT(sun.elevation.value, 89.9);
}

TEST(SunOnMap, CountsFromGridNorth) {
  const double noon = *utc_seconds("2019-04-11T03:01:21Z");
  const Crs utm = Crs::from_text("EPSG:32651"), degrees = Crs::from_text("EPSG:4326");
  const auto [x, y] = CrsTransform(degrees, utm)(120.95, 24.68);
  const double turned =
      sun_on_map(noon, utm, x, y).azimuth.value - sun_on_map(noon, degrees, 120.95, 24.68).azimuth.value;
  EXPECT_NEAR(turned, 0.856, 0.005);  // west of the meridian grid north lies west of true north
}

TEST(SunOnMap, KnowsTheEarthOnly) {
  EXPECT_THAT(message_of([] { sun_on_map(0, Crs::from_text("IAU_2015:49910"), 0, 0); }),
              HasSubstr("on Mars"));
  EXPECT_THAT(message_of([] { sun_on_map(0, Crs::local(), 0, 0); }), HasSubstr("on no body"));
}

TEST(SunFromDirection, IsTheInverseOfTowards) {
  for (double azimuth = 0; azimuth < 360; azimuth += 17)
    for (double elevation = 1; elevation < 90; elevation += 11) {
      const Sun sun = sun_from_direction(7 * sun_direction({Degrees{azimuth}, Degrees{elevation}}).unit);
      EXPECT_NEAR(sun.azimuth.value, azimuth, 1e-9);
      EXPECT_NEAR(sun.elevation.value, elevation, 1e-9);
    }
}

TEST(UtcSeconds, ReadsTimesThatSayWhereTheyAre) {
  EXPECT_EQ(utc_seconds("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(utc_seconds("1970-01-02T01:00:00+01:00"), 86400);
  EXPECT_EQ(utc_seconds("1969-12-31T23:30-0030"), 0);
  EXPECT_EQ(utc_seconds("2000-02-29T12:00:00.5Z"), 951825600.5);
  EXPECT_EQ(utc_text(951825600.5), "2000-02-29T12:00:00Z");
  EXPECT_EQ(utc_text(-1), "1969-12-31T23:59:59Z");
}

TEST(UtcSeconds, RefusesLocalTimeAndNonsense) {
  for (const char* text :
       {"2019-04-11T11:01:21", "2019-02-30T00:00:00Z", "yesterday", "", "2019-04-11 11:01:21 CST"})
    EXPECT_FALSE(utc_seconds(text)) << text;
}

TEST(LabelSun, ReadsAnglesOfPlanetaryLabels) {
  const LabelSun pds = label_sun(
      "PDS_VERSION_ID = PDS3\r\n  INCIDENCE_ANGLE  = 49.996 <DEG>\r\n SUB_SOLAR_AZIMUTH = 211.5 <DEG>");
  EXPECT_NEAR(pds.image_angle->value, 211.5, 1e-12);
  EXPECT_NEAR(pds.elevation->value, 40.004, 1e-12);
  EXPECT_FALSE(label_sun("NOT_SUB_SOLAR_AZIMUTH = 5").image_angle);
  EXPECT_FALSE(label_sun("INCIDENCE_ANGLE = -1e32").elevation);
}

TEST(UtcTime, KeepsMilliseconds) {
  for (const char* text : {"2021-02-18T20:51:06.250Z", "2021-02-18T20:51:06Z", "1969-12-31T23:59:59.999Z"})
    EXPECT_EQ(importers::precise_utc_text(*importers::utc_seconds(text)), text);
  EXPECT_EQ(importers::precise_utc_text(59.9999), "1970-01-01T00:01:00Z");
}

}  // namespace
}  // namespace waymark::test

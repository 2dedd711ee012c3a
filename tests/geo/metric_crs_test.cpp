// SPDX-License-Identifier: Apache-2.0
#include "geo/metric_crs.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {

std::string fitting(const char* crs, double lon, double lat) {
  return fitting_metric_crs(
      {.columns = 3, .rows = 3, .where = {Crs::from_text(crs), lon - 0.01, lat + 0.01, 0.01, -0.01}});
}

TEST(FittingMetricCrs, NamesTheUtmZoneOfTheMiddle) {
  EXPECT_EQ(fitting("EPSG:4326", 8.5, 46.5), "EPSG:32632");
  EXPECT_EQ(fitting("EPSG:4326", -84.2, 36.3), "EPSG:32616");
  EXPECT_EQ(fitting("EPSG:4326", -70.5, -33), "EPSG:32719");
  EXPECT_EQ(fitting("EPSG:4326", 358, 51), "EPSG:32630");
  EXPECT_EQ(fitting("EPSG:4326", 0, 88), "EPSG:5041");
  EXPECT_EQ(fitting("EPSG:4326", 0, -88), "EPSG:5042");
}

TEST(FittingMetricCrs, HasNoZonesOffTheEarth) {
  // IAU_2015:49900 is the sphere of Mars.
  const std::string mars = fitting("IAU_2015:49900", 137.4, -4.6);
  EXPECT_EQ(mars, "'+proj=tmerc +lat_0=-4.6000 +lon_0=137.4000 +a=3396190 +b=3396190 +units=m +no_defs'");
  const Crs crs = Crs::from_text(mars.substr(1, mars.size() - 2));
  EXPECT_EQ(crs.kind(), CrsKind::projected);
  EXPECT_EQ(crs.body().name, "Mars");
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "exporters/records/lonlat_footprint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

bool is_inside(const std::vector<LonLat>& ring, LonLat at) {
  bool inside = false;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const LonLat &a = ring[i], &b = ring[i + 1];
    if ((a.lat > at.lat) != (b.lat > at.lat) &&
        at.lon < a.lon + (at.lat - a.lat) / (b.lat - a.lat) * (b.lon - a.lon))
      inside = !inside;
  }
  return inside;
}

double signed_area(const std::vector<LonLat>& ring) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    sum += ring[i].lon * ring[i + 1].lat - ring[i + 1].lon * ring[i].lat;
  return sum / 2;
}

TEST(LonLatFootprint, BoxOfDegreesIsItself) {
  const auto area = lonlat_footprint({10, 40, 12, 41}, Crs::from_text("EPSG:4326"));
  ASSERT_EQ(area.rings.size(), 1U);
  EXPECT_DOUBLE_EQ(signed_area(area.rings[0]), 2);
  EXPECT_EQ((std::vector{area.west, area.south, area.east, area.north}),
            (std::vector<double>{10, 40, 12, 41}));
}

TEST(LonLatFootprint, DividedAtTheAntimeridian) {
  const auto area = lonlat_footprint({170, -5, 200, 5}, Crs::from_text("IAU_2015:49900"));
  ASSERT_EQ(area.rings.size(), 2U);
  EXPECT_DOUBLE_EQ(signed_area(area.rings[0]), 10 * 10);
  EXPECT_DOUBLE_EQ(signed_area(area.rings[1]), 20 * 10);
  EXPECT_EQ((std::vector{area.west, area.south, area.east, area.north}),
            (std::vector<double>{170, -5, -160, 5}));
}

TEST(LonLatFootprint, LongitudesTo360AreTheWholeBody) {
  const auto area = lonlat_footprint({0, -90, 360, 90}, Crs::from_text("IAU_2015:30100"));
  ASSERT_EQ(area.rings.size(), 1U);
  EXPECT_DOUBLE_EQ(signed_area(area.rings[0]), 360 * 180);
}

TEST(LonLatFootprint, PoleInsideMeansAllLongitudes) {
  const Crs south = Crs::from_text("IAU_2015:30135");  // Moon, south polar stereographic
  const auto area = lonlat_footprint({-1e5, -2e5, 3e5, 1e5}, south);
  EXPECT_EQ((std::vector{area.west, area.south, area.east}), (std::vector<double>{-180, -90, 180}));
  EXPECT_NEAR(area.north, -90 + std::hypot(3e5, 2e5) / 1737400 * 180 / 3.14159265, 0.1);
}

// Random rectangles of three projections: a point of the rectangle is in the area, one outside is not.
TEST(LonLatFootprint, HoldsThePointsOfTheRectangle) {
  std::mt19937 random(4711);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const char* crs_name : {"EPSG:32601", "EPSG:3031", "IAU_2015:49910"}) {
    const Crs crs = Crs::from_text(crs_name);
    const CrsTransform to_body(crs, geographic_crs(crs));
    const double middle = crs_name == std::string("EPSG:32601") ? 500'000 : 0;
    int inside = 0, outside = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const double x = middle + 8e5 * (unit(random) - 0.5) * (middle > 0 ? 0.4 : 5),
                   y = 2e6 * (unit(random) - 0.3);
      const double w = 1e3 + 3e5 * unit(random), h = 1e3 + 3e5 * unit(random);
      const auto area = lonlat_footprint({x, y, x + w, y + h}, crs);
      for (const auto& ring : area.rings) EXPECT_GT(signed_area(ring), 0) << crs_name << trial;
      for (int i = 0; i < 50; ++i) {
        const double u = 1.4 * unit(random) - 0.2, v = 1.4 * unit(random) - 0.2;
        // The sides are chords of 16 parts: points within 1 % of a side may fall on either side.
        const auto near = [](double t) { return std::abs(t) < 0.01 || std::abs(t - 1) < 0.01; };
        if (near(u) || near(v)) continue;
        const auto at = to_body(x + u * w, y + v * h);
        const bool expected = u > 0 && u < 1 && v > 0 && v < 1;
        bool found = false;
        for (const auto& ring : area.rings) found = found || is_inside(ring, {at.x, at.y});
        EXPECT_EQ(found, expected || (area.rings.size() == 1 && area.east - area.west == 360 && found))
            << crs_name << " trial " << trial << ": " << u << ' ' << v;
        ++(expected ? inside : outside);
      }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(outside, 1000);
  }
}

TEST(LonLatFootprint, CoordinatesOutsideTheCrsAreRefused) {
  EXPECT_THROW(lonlat_footprint({0, 0, 1e12, 1e12}, Crs::from_text("EPSG:32632")), Error);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "geo/local_frame.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {

void expect_near(const Eigen::Vector3d& found, const Eigen::Vector3d& wanted, double tolerance) {
  EXPECT_LE((found - wanted).norm(), tolerance) << found.transpose() << " is not " << wanted.transpose();
}

TEST(LocalFrame, IsEastNorthUpInMetres) {
  const LocalFrame frame(Crs::from_text("EPSG:4326"), {{8, 46, 500}});
  expect_near(frame.map_frame_from_crs({{8, 46, 500}}).xyz, {0, 0, 0}, 1e-6);
  expect_near(frame.map_frame_from_crs({{8, 46, 600}}).xyz, {0, 0, 100}, 1e-6);
  const Eigen::Vector3d east = frame.map_frame_from_crs({{8.001, 46, 500}}).xyz;
  EXPECT_NEAR(east.x(), 77.47, 0.01);  // a cos(46 deg) / sqrt(1 - e^2 sin^2) per radian
  EXPECT_NEAR(east.y(), 0, 0.001);
}

TEST(LocalFrame, ComesBackFromAnyCrs) {
  for (const char* crs : {"EPSG:4326", "EPSG:32632", "EPSG:2056", "IAU_2015:49900", "local"}) {
    const bool degrees = std::string(crs) == "EPSG:4326" || std::string(crs) == "IAU_2015:49900";
    const Point<MapCrs> origin{degrees ? Eigen::Vector3d(8, 46, 100)
                                       : Eigen::Vector3d(2600000, 1200000, 100)};
    const LocalFrame frame(Crs::from_text(crs), origin);
    const Point<MapFrame> place{{1234.5, -678.9, 12}};
    expect_near(frame.map_frame_from_crs(frame.crs_from_map_frame(place)).xyz, place.xyz, 2e-4);
  }
}

TEST(LocalFrame, OfALocalCrsIsAShift) {
  const LocalFrame frame(Crs::local(), {{10, 20, 30}});
  expect_near(frame.map_frame_from_crs({{11, 22, 33}}).xyz, {1, 2, 3}, 0);
  EXPECT_EQ(frame.origin().xyz, Eigen::Vector3d(10, 20, 30));
}

TEST(LocalFrame, HasNoSeamAtTheAntimeridian) {
  const LocalFrame frame(Crs::from_text("EPSG:4326"), {{180, 0, 0}});
  const Eigen::Vector3d a = frame.map_frame_from_crs({{179.999, 0, 0}}).xyz;
  const Eigen::Vector3d b = frame.map_frame_from_crs({{-179.999, 0, 0}}).xyz;
  EXPECT_NEAR(a.x(), -b.x(), 1e-6);
}

}  // namespace
}  // namespace waymark::test

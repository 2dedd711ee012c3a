// SPDX-License-Identifier: Apache-2.0
#include "geo/point_at_height.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "core/random.hpp"

namespace waymark::test {
namespace {

TEST(PointAtHeight, IsTheInverseOfTheMapFrameOnMountains) {
  Random random(5, "points at heights");
  double aside_of_plane = 0;
  for (const auto& [crs, lon, lat] :
       {std::tuple("EPSG:4326", -70.5, -32.5), std::tuple("EPSG:4326", 7.9, 46.4),
        std::tuple("IAU_2015:49900", 77.4, 18.4)}) {
    const LocalFrame frame(Crs::from_text(crs), {{lon, lat, 0}});
    for (int i = 0; i < 100; ++i) {
      const Point<MapCrs> there{
          {lon + random.uniform(-0.5, 0.5), lat + random.uniform(-0.5, 0.5), random.uniform(-3000, 6000)}};
      const Eigen::Vector2d place = frame.map_frame_from_crs(there).xyz.head<2>();
      const Eigen::Vector3d found = point_at_height(frame, place, there.xyz.z()).xyz;
      const double metres = 111'000;  // per degree, at most
      EXPECT_LT((found - there.xyz).head<2>().norm() * metres, 0.02);
      EXPECT_NEAR(found.z(), there.xyz.z(), 1.5);
      const Eigen::Vector3d plane = frame.crs_from_map_frame({{place.x(), place.y(), 0}}).xyz;
      aside_of_plane = std::max(aside_of_plane, (plane - there.xyz).head<2>().norm() * metres);
    }
  }
  EXPECT_GT(aside_of_plane, 30);
}

TEST(PlanPosition, IsThatOfTheGroundOfTheOrigin) {
  const LocalFrame low(Crs::from_text("IAU_2015:49900"), {{77.4, 18.4, 0}}),
      high(Crs::from_text("IAU_2015:49900"), {{77.4, 18.4, -2500}});
  const Point<MapCrs> there{{77.45, 18.45, -2500}};  // 4 km away, on the floor of Jezero
  const Eigen::Vector2d truth = high.map_frame_from_crs(there).xyz.head<2>();
  EXPECT_LT((plan_position(high, 77.45, 18.45) - truth).norm(), 1e-9);
  EXPECT_GT((plan_position(low, 77.45, 18.45) - truth).norm(), 2.5);
  EXPECT_LT((low.map_frame_from_crs(there).xyz.head<2>() - truth).norm(), 1e-6);
  EXPECT_LT((point_of_pose(high, {truth.x(), truth.y(), 0}).xyz - there.xyz).head<2>().norm() * 6e4, 0.01);
}

TEST(PointAtHeight, IsATranslationInALocalCrs) {
  const LocalFrame frame(Crs::local(), {{100, 200, 0}});
  EXPECT_EQ(point_at_height(frame, {3, 4}, 7).xyz, Eigen::Vector3d(103, 204, 7));
}

TEST(PointAtHeight, OfAPoseWithoutHeightIsOnTheTangentPlane) {
  const LocalFrame frame(Crs::from_text("EPSG:4326"), {{-70.5, -32.5, 0}});
  const Eigen::Vector3d plane = frame.crs_from_map_frame({{40'000, 0, 0}}).xyz;
  EXPECT_EQ(point_of_pose(frame, {40'000, 0, 0}).xyz, plane);
  EXPECT_EQ(point_of_pose(frame, {40'000, 0, 4000}).xyz, point_at_height(frame, {40'000, 0}, 4000).xyz);
  EXPECT_GT((point_of_pose(frame, {40'000, 0, 4000}).xyz - plane).head<2>().norm(), 2e-4);  // degrees
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_projection.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

namespace waymark::test {
using namespace exporters;
namespace {

const Crs kMoon = Crs::from_text("IAU_2015:30100");
const Crs kPole = Crs::from_text("+proj=stere +lat_0=-90 +R=1737400 +units=m");

TEST(WebProjection, PositionsComeBack) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> lon(-180, 180), lat(-85, 85), metres(-2e6, 2e6);
  const WebProjection moon(kMoon, WebPlane::mercator), plane(Crs::local(), WebPlane::metres);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d at(lon(random), lat(random)), local(metres(random), metres(random));
    EXPECT_TRUE(moon.from_world(*moon.to_world(at.x(), at.y())).isApprox(at, 1e-11));
    EXPECT_TRUE(plane.from_world(*plane.to_world(local.x(), local.y())).isApprox(local, 1e-11));
  }
}

TEST(WebProjection, LongitudesDifferByWholeTurns) {
  const WebProjection moon(kMoon, WebPlane::mercator);
  EXPECT_NEAR(moon.to_world(190, 10)->x(), moon.to_world(-170, 10)->x(), 1e-12);
  EXPECT_LT(moon.to_world(180, 0)->x(), 1);
  EXPECT_EQ(moon.to_world(0, 86), std::nullopt);
}

TEST(WebProjection, WidthOfTheWorldIsThatOfTheGround) {
  // East and west of a place, a thousandth of the world apart, on an ellipsoid flatter than any planet's.
  const Crs crs = Crs::from_text("+proj=longlat +a=3396190 +b=3376200");
  const WebProjection projection(crs, WebPlane::mercator);
  const Geodesic geodesic(crs.body());
  for (const double latitude : {-80.0, -45.0, 0.0, 18.4, 60.0}) {
    const Eigen::Vector2d at = *projection.to_world(77, latitude);
    constexpr double part = 1e-4;
    const double metres = geodesic.distance({77, latitude}, {77 + 360 * part, latitude});
    EXPECT_NEAR(projection.world_width(at.y()) * part / metres, 1, 1e-6) << latitude;
  }
}

TEST(WebProjection, LocalMetresAreToScaleEverywhere) {
  const WebProjection plane(Crs::local(), WebPlane::metres);
  const double width = 2 * std::numbers::pi * kWebRadius;
  for (const double far : {0.0, 1e3, 5e6}) {
    const Eigen::Vector2d a = *plane.to_world(far, -far), b = *plane.to_world(far + 300, -far + 400);
    EXPECT_NEAR((b - a).norm() * width, 500, 1e-6);
    EXPECT_DOUBLE_EQ(plane.world_width(a.y()), width);
  }
  EXPECT_LT(plane.to_world(0, 100)->y(), 0.5);  // north is up
}

TEST(WebProjection, PolarMapsAreDrawnOnTheirPlane) {
  EXPECT_EQ(web_plane(kPole, exporters::MapBox{-1e5, -1e5, 1e5, 1e5}), WebPlane::metres);
  EXPECT_EQ(web_plane(kPole, exporters::MapBox{5e5, 5e5, 6e5, 6e5}), WebPlane::mercator);
  EXPECT_EQ(web_plane(Crs::from_text("EPSG:32632"), exporters::MapBox{4e5, 5e6, 4.1e5, 5.1e6}),
            WebPlane::mercator);
  EXPECT_EQ(web_plane(kMoon, exporters::MapBox{0, -89, 10, -80}), WebPlane::mercator);
  EXPECT_EQ(web_plane(Crs::local(), std::nullopt), WebPlane::metres);
  const WebProjection plane(kPole, WebPlane::metres);
  EXPECT_NEAR((*plane.to_world(3000, 4000) - *plane.to_world(0, 0)).norm() * plane.world_width(0.5), 5000,
              1e-6);
}

}  // namespace
}  // namespace waymark::test

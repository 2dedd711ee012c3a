// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/map_landmark.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geo/axes_rotation.hpp"

namespace waymark::test {
using namespace localization;
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// South polar stereographic, at 90 degrees east: x grows to the north, y to the west.
TEST(MapLandmark, OfAPolarMapHasCovarianceAndDirectionAlongEastAndNorth) {
  const Crs polar = Crs::from_text("IAU_2015:30135");
  const auto at = CrsTransform(geographic_crs(polar), polar)(90, -89);
  const LocalFrame frame(polar, {{at.x, at.y, 0}});
  LandmarkType type;
  type.features = {{.name = "radius", .unit = "m", .scale = Scale::ratio, .summary = ""},
                   {.name = "orientation", .unit = "rad", .scale = Scale::axis, .summary = ""}};
  constexpr std::size_t orientation = 1;
  Landmark landmark;
  landmark.position = frame.origin();
  landmark.covariance = Eigen::Vector3d(4, 1, 0.25).asDiagonal();
  landmark.features.resize(type.features.size());
  landmark.features[orientation] = {0.3, 0.01, 2};  // clockwise from the y axis of the map
  const MapLandmark robots = map_landmark(landmark, type, frame);
  EXPECT_NEAR(robots.covariance(0, 0), 1, 1e-6);
  EXPECT_NEAR(robots.covariance(1, 1), 4, 1e-6);
  EXPECT_NEAR(std::remainder(robots.features.value[orientation] - (0.3 - kQuarter), std::numbers::pi), 0,
              1e-6);

  const LocalFrame local(Crs::local(), {});
  const MapLandmark same = map_landmark(landmark, type, local);
  EXPECT_EQ(same.covariance(0, 0), 4);
  EXPECT_EQ(same.features.value[orientation], 0.3);
}

// Eq. 8 says how well a landmark is known, not whether it exists: without a confidence none is left out.
TEST(MapLandmark, OnlyAConfidenceSaysThatALandmarkRatherDoesNotExist) {
  Landmark landmark;
  landmark.quality.visible = 4, landmark.quality.seen = 1;
  landmark.confidence = std::nan("");
  const LocalFrame local(Crs::local(), {});
  const MapLandmark observed = map_landmark(landmark, {}, local);
  EXPECT_LT(observed.quality, kLikelyExistence);
  EXPECT_FALSE(observed.has_confidence);
  landmark.confidence = 0.3;
  const MapLandmark doubtful = map_landmark(landmark, {}, local);
  EXPECT_EQ(doubtful.quality, 0.3);
  EXPECT_TRUE(doubtful.has_confidence);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/dem_shift.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/fusion/made_images.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

Terrain moved(const Terrain& dem, const Eigen::Vector2d& by) {
  return {dem.heights(), dem.x0() + by.x(), dem.y0() + by.y(), dem.step_x(), dem.step_y(), 0.1};
}

std::vector<ImageView> with_shifts(const MadeImages& made, const Terrain& dem) {
  std::vector<ImageView> images = made.given;
  for (std::size_t i = 0; i < images.size(); ++i)
    images[i].dem_shift = measure_dem_shift(made.pixels[i], images[i], dem, 1);
  return images;
}

TEST(DemShift, IsMeasuredFarBeyondTheStatedPoses) {
  for (const std::int64_t seed : {15, 16}) {
    const MadeImages made = made_images(descent(seed));
    const Eigen::Vector2d by(6, -3.5);
    const std::vector<ImageView> images = with_shifts(made, moved(made.dem, by));
    const auto seen = common_dem_shift(images);
    ASSERT_TRUE(seen) << seed;
    EXPECT_TRUE(seen->significant) << seed;
    EXPECT_LT((seen->metres + by).norm(), 3 * seen->sd + 0.6)  // plus that of the poses of three images
        << seed << ": " << seen->metres.transpose();
    EXPECT_LT(seen->sd, 1.6 / 2) << "half a cell";
  }
}

TEST(DemShift, IsTheSameForPosesMovedTheOtherWay) {
  MadeImages made = made_images(descent(15));
  for (ImageView& image : made.given) {
    image.view->grid_from_camera.transform.translation() += Eigen::Vector3d(-6, 3.5, 0);
    compute_footprint(image, made.dem, 1);
  }
  const auto seen = common_dem_shift(with_shifts(made, made.dem));
  ASSERT_TRUE(seen);
  EXPECT_TRUE(seen->significant);
  EXPECT_LT((seen->metres - Eigen::Vector2d(-6, 3.5)).norm(), 3 * seen->sd + 0.6);
}

TEST(DemShift, IsNotSignificantOnSoundLandings) {
  int measured = 0;
  for (std::int64_t seed = 21; seed < 29; ++seed) {
    testbed::Scenario scenario = descent(seed);
    scenario.ground.relief.rms = 1 + 1.5 * double(seed - 21);
    scenario.exposure.sun.elevation = Degrees{25 + 5 * double(seed - 21)};
    scenario.exposure.sun.azimuth = Degrees{45 * double(seed - 21)};
    const MadeImages made = made_images(scenario);
    const auto seen = common_dem_shift(with_shifts(made, made.dem));
    measured += seen.has_value();
    EXPECT_FALSE(seen && seen->significant) << seed << ": " << seen->metres.transpose() << " sd " << seen->sd;
  }
  EXPECT_GE(measured, 4) << "of 8 landings must allow the measurement";
}

TEST(DemShift, OtherGroundHasNone) {
  const MadeImages made = made_images(descent(15)), other = made_images(descent(16));
  for (std::size_t i = 0; i < made.given.size(); ++i) {
    EXPECT_FALSE(measure_dem_shift(other.pixels[i], made.given[i], made.dem, 1)) << i;
    EXPECT_FALSE(measure_dem_shift(Pixels(320, 320, 100), made.given[i], made.dem, 1)) << i;
    ImageView dark = made.given[i];
    dark.sun.reset();
    EXPECT_FALSE(measure_dem_shift(made.pixels[i], dark, made.dem, 1)) << i;
  }
}

}  // namespace
}  // namespace waymark::test

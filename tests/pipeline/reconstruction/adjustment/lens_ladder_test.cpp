// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/lens_ladder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;
using ::testing::HasSubstr;

const LadderStep& step_of(const CalibratedAdjustment& found, const std::string& name) {
  return *std::ranges::find(found.steps, name, &LadderStep::parameter);
}

Camera truth_of_lens() {
  Camera camera{.columns = 1000, .rows = 750, .fx = 1000, .fy = 1000, .cx = 499.5, .cy = 374.5};
  camera.distortion[0] = -0.1;
  return camera;
}

// Starts from f + 3 % and no distortion, with points placed by that lens.
CalibratedAdjustment calibrate(MadeScene& made, const Observations& seen) {
  Camera& camera = made.start.lenses[0].camera;
  camera.fx = camera.fy = 1030;
  camera.distortion = {};
  for (TiePoint& point : made.start.points) {
    point.position.reset();
    if (const auto found = triangulate(made.start, point.marks)) point.position = found->position;
  }
  return adjust_with_ladder(made.start, seen);
}

TEST(LensLadder, ObliqueImagesOverReliefDetermineTheLens) {
  MadeScene made = made_scene({.seed = 3, .tilt = 0.4, .points = 400, .camera = truth_of_lens()});
  const Observations seen{.positions = made_positions(made.truth, 0.1, 4)};
  const CalibratedAdjustment found = calibrate(made, seen);
  for (const char* name : {"f", "k1"}) {
    const LadderStep& step = step_of(found, name);
    EXPECT_TRUE(step.admitted) << name << ": " << step.reason;
    EXPECT_LT(step.left_out_after, step.left_out_before);
  }
  EXPECT_NEAR(step_of(found, "f").value, 1000, 4 * step_of(found, "f").sd);
  EXPECT_LT(step_of(found, "f").sd, 1.5);
  EXPECT_NEAR(step_of(found, "k1").value, -0.1, 4 * step_of(found, "k1").sd);
  EXPECT_NEAR(found.adjustment.sigma0, 1, 0.1);
  // The made lens has no more terms; what enters by chance is small.
  for (const LadderStep& step : found.steps)
    if (step.admitted && step.parameter != "f" && step.parameter != "k1") {
      const double truth = step.parameter == "cx" ? 499.5 : step.parameter == "cy" ? 374.5 : 0;
      EXPECT_NEAR(step.value, truth, 4 * step.sd) << step.parameter;
    }
}

// Vertical images of a plane without known positions: focal length and height cannot be separated.
TEST(LensLadder, NadirOverAPlaneKeepsThePrior) {
  MadeScene made = made_scene({.seed = 5, .relief = 0, .points = 400, .camera = truth_of_lens()});
  for (AdjustedImage& image : made.truth.images) {
    image.world_from_camera->linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
    image.world_from_camera->translation().z() = 100;
  }
  for (TiePoint& point : made.truth.points)
    for (Mark& mark : point.marks) {
      const Eigen::Vector2d noise = mark.pixel - mark.pixel.array().round().matrix();
      mark.pixel = *project(made.truth.lenses[0].camera,
                            {made.truth.images[mark.image].world_from_camera->inverse() * *point.position}) +
                   noise;
    }
  made.start.images = made.truth.images;
  made.start.points = made.truth.points;
  const CalibratedAdjustment found = calibrate(made, {});
  const LadderStep& f = step_of(found, "f");
  EXPECT_FALSE(f.admitted);
  EXPECT_EQ(f.value, 1030);
  EXPECT_FALSE(f.reason.empty());
  EXPECT_EQ(made.start.lenses[0].camera.fx, 1030);
  std::printf("f stays: %s\n", f.reason.c_str());
}

// Vertical images of little relief: residuals hardly depend on the focal length, so that small unmodelled
// errors decide.
TEST(LensLadder, WeakGeometryDoesNotOverruleWhatIsKnown) {
  const MadeSceneOptions flight{.seed = 11, .columns = 6, .relief = 4, .points = 500, .mark_sd = 0.3};
  const Observations known{.lenses = {{0, "f", 1080, 12}}};
  const auto focal_length = [&](const LadderOptions& options, CalibratedAdjustment& found) {
    MadeScene made = made_scene(flight);
    Camera& camera = made.start.lenses[0].camera;
    camera.fx = camera.fy = 1080;
    found = adjust_with_ladder(made.start, known, {}, options);
    return made.start.lenses[0].camera.fx;
  };
  CalibratedAdjustment trusting, found;
  const LadderOptions no_limits{.max_sd = 2, .max_deviation = 1e9};
  EXPECT_LT(focal_length(no_limits, trusting), 1060) << step_of(trusting, "f").reason;
  EXPECT_EQ(focal_length({.max_sd = 2}, found), 1080) << step_of(found, "f").value;
  EXPECT_THAT(step_of(found, "f").reason, HasSubstr("standard deviations from what is known"));
}

// Metadata that lie are overruled where images determine the focal length well.
TEST(LensLadder, StrongGeometryOverrulesAWrongPrior) {
  MadeScene made = made_scene({.seed = 3, .tilt = 0.4, .points = 400, .camera = truth_of_lens()});
  Observations seen{.positions = made_positions(made.truth, 0.1, 4)};
  seen.lenses = {{0, "f", 1150, 30}};
  Camera& camera = made.start.lenses[0].camera;
  camera.fx = camera.fy = 1150;
  camera.distortion = {};
  for (TiePoint& point : made.start.points) {
    point.position.reset();
    if (const auto found = triangulate(made.start, point.marks)) point.position = found->position;
  }
  const CalibratedAdjustment found = adjust_with_ladder(made.start, seen);
  EXPECT_TRUE(step_of(found, "f").admitted) << step_of(found, "f").reason;
  EXPECT_TRUE(step_of(found, "f").contradicts);
  EXPECT_EQ(step_of(found, "f").prior_value, 1150);
  // The prior does not pull any more.
  EXPECT_NEAR(std::ranges::find(found.priors, "f", &LensPrior::parameter)->sd, 150, 10);
  EXPECT_NEAR(made.start.lenses[0].camera.fx, 1000, 10);
}

TEST(LensLadder, FisheyesAreCalibrated) {
  Camera camera{.columns = 1000, .rows = 1000, .fx = 500, .fy = 500, .cx = 499.5, .cy = 499.5};
  camera.lens = Camera::Lens::fisheye;
  camera.distortion = {0.1203, 0.0337};  // the lander camera of Mars 2020
  MadeScene made = made_scene({.seed = 6, .tilt = 0.3, .points = 400, .camera = camera});
  const Observations seen{.positions = made_positions(made.truth, 0.1, 7)};
  made.start.lenses[0].camera.fx = made.start.lenses[0].camera.fy = 510;
  made.start.lenses[0].camera.distortion[0] = 0.08;
  const CalibratedAdjustment found = adjust_with_ladder(made.start, seen);
  EXPECT_TRUE(step_of(found, "f").admitted) << step_of(found, "f").reason;
  EXPECT_TRUE(step_of(found, "k1").admitted) << step_of(found, "k1").reason;
  EXPECT_NEAR(made.start.lenses[0].camera.fx, 500, 1.5);
  EXPECT_EQ(std::ranges::count(found.steps, "p1", &LadderStep::parameter), 0);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/dem_registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "pipeline/fusion/association/alignment.hpp"
#include "pipeline/fusion/projection/position_covariance.hpp"
#include "pipeline/fusion/projection/shaded_relief.hpp"
#include "tests/pipeline/fusion/made_images.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using Vector6 = Eigen::Vector<double, 6>;

Vector6 correction(const PosedCamera& given, const PosedCamera& truth) {
  const auto &a = given.grid_from_camera.transform, &b = truth.grid_from_camera.transform;
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  Vector6 all;
  all << turn.angle() * turn.axis(), b.translation() - a.translation();
  return all;
}

// Returns the shift of the ground at the image centre due to a pose correction.
Eigen::Vector2d shift(const ImageView& image, const Terrain& ground, const Vector6& by) {
  const auto line = viewing_ray(image, {double(image.columns) / 2, double(image.rows) / 2});
  const GroundPlane plane{ground.cast(*line).point.xyz, Eigen::Vector2d::Zero()};
  return (pose_jacobian(image, *line, plane) * by).head<2>();
}

TEST(GroundMatch, FindsWhereAnImageLies) {
  const MadeImages made = made_images(descent(5));
  for (std::size_t i = 0; i < made.given.size(); ++i) {
    const auto tie = register_to_dem(made.pixels[i], made.given[i], made.dem, 1);
    ASSERT_TRUE(tie) << i;
    const Eigen::Matrix<double, 6, 6> all = tie->information + made.given[i].view->covariance.inverse();
    const Vector6 truth = correction(*made.given[i].view, made.truth[i]),
                  found = all.ldlt().solve(tie->information_vector);
    const Eigen::Vector2d off = shift(made.given[i], made.dem, found - truth);
    EXPECT_LT(off.norm(), 0.1) << i << ": given " << shift(made.given[i], made.dem, truth).norm();
    // Consistent except for the common errors of the DEM (AlignmentRules).
    EXPECT_LT((found - truth).dot(all * (found - truth)), 40) << i;
  }
}

TEST(GroundMatch, SaysNothingOfOtherGround) {
  const MadeImages made = made_images(descent(5)), other = made_images(descent(6));
  for (std::size_t i = 0; i < made.given.size(); ++i) {
    EXPECT_FALSE(register_to_dem(other.pixels[i], made.given[i], made.dem, 1)) << i;
    ImageView dark = made.given[i];
    dark.sun.reset();
    EXPECT_FALSE(register_to_dem(made.pixels[i], dark, made.dem, 1));
    const Pixels grey(made.given[i].columns, made.given[i].rows, 100);
    EXPECT_FALSE(register_to_dem(grey, made.given[i], made.dem, 1));
    const Terrain level(Grid<float>(300, 300, float(made.dem.max_height())), -240, 240, 1.6, 1.6);
    EXPECT_FALSE(register_to_dem(made.pixels[i], made.given[i], level, 1));
  }
}

TEST(GroundMatch, TakesOutWhatAllImagesAreOffByTogether) {
  testbed::Scenario scenario = descent(7);
  scenario.flights.front().images = 6;
  scenario.lens.columns = scenario.lens.rows = 600;
  MadeLanding made = made_landing(scenario);
  std::vector<PosedCamera> truth;
  for (const testbed::Shot& shot : testbed::plan_shots(scenario)) truth.push_back(shot.view);
  const Eigen::Vector3d together(0.5, -0.4, 0);  // invisible to comparisons between images
  for (ImageView& image : made.images) image.view->grid_from_camera.transform.translation() += together;
  for (Observation& o : made.observations) o.position.xyz += together;
  const auto mean_error = [&](const Alignment& aligned) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double n = 0;
    for (std::size_t i = 0; i < aligned.observations.size(); ++i)
      if (made.thing[i] >= 0)
        sum += aligned.observations[i].position.xyz.head<2>() - made.true_position(made.thing[i]), ++n;
    return (sum / n).norm();
  };
  const auto aligned = [&] {
    return align_images(made.observations, made.images, made.dem, made.types, Crs::local());
  };
  const Alignment alone = aligned();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    PoseConstraint tie;
    tie.information.diagonal() << 1e8, 1e8, 1e8, 2500, 2500, 2500;
    tie.information_vector = tie.information * correction(*made.images[i].view, truth[i]);
    made.images[i].dem_constraint = tie;
  }
  const Alignment constrained = aligned();
  EXPECT_GT(mean_error(alone), 0.4);
  EXPECT_LT(mean_error(constrained), 0.1);
  EXPECT_LT(constrained.images[0].common_covariance.trace(), alone.images[0].common_covariance.trace() / 10);
  // All images use the same DEM, so its error does not average out.
  EXPECT_GT(constrained.images[0].common_covariance.trace(), 2 * 0.02 * 0.02 / 2);
}

// The contribution of an uncertain pose on a slope must be removed as it was added. Removed as on level
// ground, it leaves half of the ellipses too small.
TEST(GroundMatch, PlacesOnSlopesStayHonest) {
  testbed::Scenario scenario = descent(8);
  scenario.ground.relief.rms = 12;
  scenario.ground.rocks.k = 0.08;
  scenario.lens.columns = scenario.lens.rows = 600;
  scenario.pose_errors = {0.8, Degrees{0.1}};
  MadeLanding made = made_landing(scenario);
  const std::vector<testbed::Shot> shots = testbed::plan_shots(scenario);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    PoseConstraint tie;
    tie.information.diagonal() << 1e10, 1e10, 1e10, 1e6, 1e6, 1e6;
    tie.information_vector = tie.information * correction(*made.images[i].view, shots[i].view);
    made.images[i].dem_constraint = tie;
  }
  const Alignment aligned = align_images(made.observations, made.images, made.dem, made.types, Crs::local());
  int inside = 0, all = 0;
  for (std::size_t i = 0; i < made.observations.size(); ++i) {
    if (made.thing[i] < 0) continue;
    const Observation& o = aligned.observations[i];
    const Eigen::Vector2d error = o.position.xyz.head<2>() - made.true_position(made.thing[i]);
    const Eigen::Matrix2d covariance =
        o.covariance.topLeftCorner<2, 2>() + aligned.images[0].common_covariance;
    inside += error.dot(covariance.inverse() * error) <= 4.605;
    ++all;
  }
  EXPECT_GE(all, 300);
  EXPECT_GE(inside, 0.8 * all);
}

TEST(ShadedRelief, FinePartIsWithoutTheMeanOfItsNeighbours) {
  Grid<float> values(7, 5, 0);
  for (std::int64_t r = 0; r < 5; ++r)
    for (std::int64_t c = 0; c < 7; ++c) values(c, r) = static_cast<float>((c * 7 + r * 3) % 5);
  values(3, 2) = std::nanf("");
  const Grid<float> fine = high_pass(values, 1);
  for (std::int64_t r = 0; r < 5; ++r)
    for (std::int64_t c = 0; c < 7; ++c) {
      double sum = 0, n = 0;
      for (std::int64_t b = -1; b <= 1; ++b)
        for (std::int64_t a = -1; a <= 1; ++a)
          if (values.contains(c + a, r + b) && !std::isnan(values(c + a, r + b)))
            sum += double(values(c + a, r + b)), ++n;
      if (std::isnan(values(c, r)))
        EXPECT_TRUE(std::isnan(fine(c, r)));
      else
        EXPECT_NEAR(fine(c, r), double(values(c, r)) - sum / n, 1e-5) << c << ' ' << r;
    }
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

TEST(Triangulate, ExactMarksGiveThePoint) {
  const MadeScene made = made_scene({.mark_sd = 0, .corner = {999000, 5123000, 140}});
  for (const TiePoint& point : made.truth.points) {
    const auto found = triangulate(made.truth, point.marks);
    ASSERT_TRUE(found);
    EXPECT_LT((found->position - *point.position).norm(), 1e-6);
    EXPECT_LT(found->rms, 1e-6);
  }
}

TEST(Triangulate, CovariancesPassTheChiSquareTest) {
  const MadeScene made = made_scene({.seed = 2, .points = 1000});
  double sum = 0, count = 0;
  for (const TiePoint& point : made.truth.points) {
    const auto found = triangulate(made.truth, point.marks);
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->position - *point.position;
    sum += error.dot(found->covariance.ldlt().solve(error)) / 3;
    ++count;
  }
  EXPECT_NEAR(sum / count, 1, 0.1);  // 3 sd of a mean of some 700 chi-squares of 3 freedoms
}

// Two cameras 20 m apart, 100 m above a point between them: 2 atan(0.1).
TEST(Triangulate, AngleIsThatOfTheRays) {
  const Camera camera{.columns = 100, .rows = 100, .fx = 100, .fy = 100, .cx = 50, .cy = 50};
  std::vector<PosedMark> marks(2);
  for (int i = 0; i < 2; ++i) {
    PosedMark& mark = marks[static_cast<std::size_t>(i)];
    mark.camera = &camera;
    mark.world_from_camera.translation().x() = i == 0 ? -10 : 10;
    mark.pixel = {i == 0 ? 60 : 40, 50};
  }
  const auto found = triangulate(marks);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->angle, 2 * std::atan(0.1), 1e-12);
  EXPECT_LT((found->position - Eigen::Vector3d(0, 0, 100)).norm(), 1e-9);
  // Rays that part, and parallel ones.
  std::swap(marks[0].pixel, marks[1].pixel);
  EXPECT_FALSE(triangulate(marks));
  marks[0].pixel = marks[1].pixel;
  EXPECT_FALSE(triangulate(marks));
  EXPECT_FALSE(triangulate(std::span(marks).first(1)));
}

}  // namespace
}  // namespace waymark::test

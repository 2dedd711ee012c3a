// SPDX-License-Identifier: Apache-2.0
// The field of all cells against the information of each cell by itself.
#include "planning/information_field.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "tests/support/small_routes.hpp"

namespace waymark::test {
namespace {

using namespace planning;

TEST(InformationField, HoldsWhatEachCellSeesPastTheTerrainForAnyNumberOfThreads) {
  const localization::LandmarkGrid map = scattered_landmarks(3);
  const auto ridge = [](const Eigen::Vector2d& at) -> std::optional<double> {
    return at.x() > 35 && at.x() < 39 ? 5.0 : 0.0;
  };
  LandmarkSensing sensor = sensing(30, 120);
  const RouteProblem open = problem_of(40, 40, map, sensor);
  sensor.visible = localization::terrain_line_of_sight(ridge, {});
  std::size_t hidden = 0;
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const InformationField field = problem_of(40, 40, map, sensor).field;
    ASSERT_EQ(field.headings, kHeadings);
    for (std::int64_t i = 0; i < field.cells.count(); ++i)
      for (int h = 0; h < kHeadings; ++h) {
        const Information alone =
            information_at(heading_pose(field.cells.x(i), field.cells.y(i), h), map, sensor);
        ASSERT_EQ(field.get(i, h).landmarks, alone.landmarks) << i << " " << h;
        ASSERT_EQ(field.get(i, h).rate.matrix(), alone.rate.matrix()) << i << " " << h;
        hidden += alone.landmarks < open.field.get(i, h).landmarks;
      }
  }
  EXPECT_GT(hidden, 100u);
}

TEST(InformationField, ReportsRowsAndEndsWhereItIsAsked) {
  struct Stop {};
  const RouteCells cells{.cell = 2, .columns = 7, .rows = 40};
  const std::vector<char> passable(280, 1);
  const localization::LandmarkGrid map = scattered_landmarks(1);
  std::vector<double> done;
  make_information_field(cells, passable, map, sensing(20), [&](double part) { done.push_back(part); });
  ASSERT_EQ(done.size(), 40);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), 1);
  EXPECT_THROW(make_information_field(cells, passable, map, sensing(20), [](double) { throw Stop(); }), Stop);
}

}  // namespace
}  // namespace waymark::test

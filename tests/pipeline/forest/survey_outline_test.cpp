// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/survey_outline.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/pipeline/forest/synthetic_canopy.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

double area(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

double area(const SurveyedPart& part) {
  double sum = area(part.outer);
  for (const auto& hole : part.holes) sum -= std::abs(area(hole));
  return sum;
}

/// Returns a canopy of 600 x 400 cells of half a metre with data where `known(column, row)`.
Canopies canopy_of(const std::function<bool(std::int64_t, std::int64_t)>& known) {
  Grid<float> heights(600, 400, kNoCanopy);
  for (std::int64_t r = 0; r < 400; ++r)
    for (std::int64_t c = 0; c < 600; ++c)
      if (known(c, r)) heights(c, r) = 3;
  return {std::make_shared<SyntheticCanopy>(std::move(heights), 0.5)};
}

TEST(SurveyOutline, OfAFullGridIsItsRectangle) {
  const auto parts = survey_outline(canopy_of([](auto c, auto r) { return (c * 7 + r) % 300 != 0; }));
  ASSERT_THAT(parts, SizeIs(1));
  EXPECT_THAT(parts[0].outer, SizeIs(4));
  EXPECT_DOUBLE_EQ(area(parts[0]), 300.0 * 200);
}

TEST(SurveyOutline, FollowsASlantedEdge) {
  const auto parts = survey_outline(canopy_of([](auto c, auto r) { return 2 * c < 3 * r; }));
  ASSERT_THAT(parts, SizeIs(1));
  EXPECT_NEAR(area(parts[0]), 300.0 * 200 / 2, 0.01 * 300 * 200);
}

TEST(SurveyOutline, LeavesOutALakeAndKeepsPits) {
  const auto parts = survey_outline(canopy_of([](auto c, auto r) {
    const bool pit = c % 100 == 50 && r % 100 == 50;
    return !pit && std::hypot(static_cast<double>(c - 300), static_cast<double>(r - 200)) > 100;
  }));
  ASSERT_THAT(parts, SizeIs(1));
  EXPECT_THAT(parts[0].holes, SizeIs(1));
  EXPECT_NEAR(area(parts[0]), 300.0 * 200 - std::acos(-1.0) * 50 * 50, 0.01 * 300 * 200);
}

TEST(SurveyOutline, IsThatOfAllSurveys) {
  Canopies both = canopy_of([](auto c, auto) { return c < 200; });
  both.push_back(canopy_of([](auto c, auto) { return c >= 150 && c < 350; })[0]);
  both.push_back(canopy_of([](auto c, auto) { return c >= 500; })[0]);
  const auto parts = survey_outline(both);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_NEAR(area(parts[0]) + area(parts[1]), (350 + 100) * 0.5 * 200, 0.01 * 300 * 200);
}

TEST(SurveyOutline, OfNothingIsEmpty) {
  EXPECT_THAT(survey_outline(canopy_of([](auto, auto) { return false; })), IsEmpty());
}

}  // namespace
}  // namespace waymark::test

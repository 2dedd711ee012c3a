// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town_survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace waymark::test {
using namespace testbed;
namespace {

std::vector<LaserReturn> survey_of(const Town& town, const StreetModel& model, std::uint64_t seed) {
  std::vector<LaserReturn> all;
  survey_town(town, model, seed,
              [&](std::span<const LaserReturn> row) { all.insert(all.end(), row.begin(), row.end()); });
  return all;
}

// The slow twin of roofs: height at a position, without a slanted ray.
double roof_height(const Town& town, const Eigen::Vector2d& at) {
  double highest = -1;
  for (const TownRoof& roof : town.roofs) {
    const Eigen::Vector2d off = (at - roof.middle).cwiseAbs();
    if (off.x() <= roof.half.x() && off.y() <= roof.half.y())
      highest = std::max(highest, roof.ridge - roof.slope * off.y());
  }
  return highest;
}

TEST(TownSurvey, ReturnsLieOnWhatStandsThere) {
  const StreetModel model{.survey_pulses = 4, .survey_shift_sd = 0};
  const Town town = plan_street(model, 5, 5);
  const std::vector<LaserReturn> returns = survey_of(town, model, 5);
  std::size_t ground = 0, roofs = 0, first = 0, others = 0;
  for (const LaserReturn& r : returns) {
    first += r.number == 1;
    ASSERT_LE(r.number, r.of);
    ASSERT_LE(r.of, 4);
    const Eigen::Vector2d at(r.x, r.y);
    if (r.kind == 2) {
      ++ground;
      ASSERT_NEAR(r.z, town.ground(at), 0.35) << at.transpose();  // a kerb beside it, and noise
    } else if (const double roof = roof_height(town, at); roof > 0 && std::abs(r.z - roof) < 0.5) {
      ++roofs;
    } else {
      ++others;
      ASSERT_LT(r.z, 14);
    }
  }
  const double area = (model.length + 30) * 40;  // about
  EXPECT_NEAR(static_cast<double>(first) / area, 4, 1.5);
  EXPECT_GT(ground, returns.size() / 4);
  EXPECT_GT(roofs, returns.size() / 4);
  EXPECT_LT(others, returns.size() / 5);  // crowns, posts, cars and walls
  const std::vector<LaserReturn> again = survey_of(town, model, 5);
  EXPECT_TRUE(std::ranges::equal(returns, again, [](const LaserReturn& a, const LaserReturn& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.number == b.number;
  }));
}

TEST(TownSurvey, EavesReachBeyondTheWalls) {
  for (const double overhang : {0.0, 0.5}) {
    const StreetModel model{
        .max_setback = 0, .tree_spacing = 0, .overhang = overhang, .survey_pulses = 20, .survey_shift_sd = 0};
    const Town town = plan_street(model, 6, 6);
    double southernmost = 1e9;
    for (const LaserReturn& r : survey_of(town, model, 6))
      if (r.y > 4 && r.z > 7.3 && r.z < 12) southernmost = std::min(southernmost, r.y);
    // The facades of the northern side stand at y = 8; returns err by 0.08 m.
    EXPECT_NEAR(southernmost, 8 - overhang, 0.35) << overhang;
  }
}

TEST(TownSurvey, PlansOfStreetsDoNotDependOnIt) {
  const Town plain = plan_street({}, 7, 7), surveyed = plan_street({.survey_pulses = 8}, 7, 7);
  EXPECT_EQ(town_table(plain), town_table(surveyed));
}

}  // namespace
}  // namespace waymark::test

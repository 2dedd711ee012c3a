// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "testbed/scenario.hpp"
#include "testbed/town/town_drive.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using testing::HasSubstr;

/// Returns the ranges along random rays from the path: what a drive would see.
std::vector<double> ranges_of(const Town& town, double sign, double t) {
  Random random(7);
  std::vector<double> ranges;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d from = sign * town.path[random.uniform_index(town.path.size())];
    const double angle = random.uniform(-3, 3);
    ranges.push_back(
        town.cast(from, sign * Eigen::Vector2d(std::cos(angle), std::sin(angle)), t).value_or(-1));
  }
  return ranges;
}

TEST(Town, TruePostsStandWhereARayMeetsThem) {
  const Town town = plan_street({.parked = 0}, 3, 3);
  int poles = 0;
  for (const TownLandmark& l : town.landmarks) {
    if (l.type != "pole" && l.type != "tree") continue;
    ++poles;
    const Eigen::Vector2d from = l.at - Eigen::Vector2d(0, std::copysign(1.0, l.at.y()));  // from the road
    const auto range = town.cast(from, (l.at - from).normalized(), 0);
    ASSERT_TRUE(range);
    EXPECT_NEAR(*range, 1 - *l.diameter / 2, 1e-9);
  }
  EXPECT_GT(poles, 30);
}

TEST(Town, CornersAreEndsOfWallsAndLookIntoTheOpen) {
  for (const Town& town : {plan_street({}, 4, 4), plan_hall({}, 4, 4)}) {
    int corners = 0;
    for (const TownLandmark& l : town.landmarks) {
      if (l.type != "wall_corner" && l.type != "wall_end") continue;
      ++corners;
      EXPECT_TRUE(std::ranges::any_of(
          town.walls,
          [&](const TownWall& w) { return (w.from - l.at).norm() < 1e-6 || (w.to - l.at).norm() < 1e-6; }))
          << l.type << l.at.transpose();
      const Eigen::Vector2d open(std::sin(*l.direction), std::cos(*l.direction));
      const auto free = town.cast(l.at + 1e-3 * open, open, 0);
      EXPECT_TRUE(!free || *free > 0.3) << l.type << " " << l.at.transpose();
    }
    EXPECT_GT(corners, 20);
  }
}

TEST(Town, WallsLieOnTheStatedSideOfTheirEnds) {
  const Town town = plan_hall({}, 4, 4);
  const auto is_wall = [&](const Eigen::Vector2d& at) {
    return std::ranges::any_of(town.walls, [&](const TownWall& w) {
      const Eigen::Vector2d run = w.to - w.from, to = at - w.from;
      const double t = std::clamp(to.dot(run) / run.squaredNorm(), 0.0, 1.0);
      return (to - t * run).norm() < 0.01;
    });
  };
  int ends = 0;
  for (const TownLandmark& l : town.landmarks) {
    if (l.type != "wall_end") continue;
    ++ends;
    // Who looks at the face looks against its normal; left of that is a quarter turn counter-clockwise.
    const Eigen::Vector2d look(-std::sin(*l.direction), -std::cos(*l.direction)), left(-look.y(), look.x());
    EXPECT_TRUE(is_wall(l.at + 0.1 * *l.side * left)) << l.at.transpose();
    EXPECT_FALSE(is_wall(l.at - 0.1 * *l.side * left)) << l.at.transpose();
  }
  EXPECT_GT(ends, 20);
}

TEST(Town, WallsAreOnBothSidesOfACorridor) {
  const HallModel model;
  const Town hall = plan_hall(model, 5, 6);
  int walls = 0, towards_the_middle = 0;
  for (const TownLandmark& l : hall.landmarks) {
    if (l.type != "wall") continue;
    ++walls;
    const Eigen::Vector2d normal(std::sin(*l.direction), std::cos(*l.direction));
    // Half a corridor in front of its face runs the middle line of the corridor.
    const double line = (std::abs(normal.x()) > 0.5 ? model.length : model.width) / 2;
    EXPECT_NEAR(std::abs(l.at.dot(normal) + model.corridor_width / 2), line, 1e-9) << l.at.transpose();
    towards_the_middle += l.at.dot(normal) < 0;
  }
  EXPECT_EQ(walls - towards_the_middle, 4);  // those of the core
  EXPECT_GT(towards_the_middle, 10);
}

TEST(Town, DrivesDifferInCarsAndDoorsOnly) {
  const auto landmarks = [](const Town& town) { return town_table(town); };
  const Town first = plan_street({}, 5, 1), second = plan_street({}, 5, 2);
  EXPECT_EQ(landmarks(first), landmarks(second));
  EXPECT_NE(ranges_of(first, 1, 0), ranges_of(second, 1, 0));
  EXPECT_NE(landmarks(first), landmarks(plan_street({}, 6, 1)));
  const Town monday = plan_hall({.people = 0}, 5, 1), tuesday = plan_hall({.people = 0}, 5, 2);
  EXPECT_EQ(landmarks(monday), landmarks(tuesday));
  EXPECT_NE(ranges_of(monday, 1, 0), ranges_of(tuesday, 1, 0));
}

TEST(Town, ASymmetricHallLooksTheSameAfterHalfATurn) {
  const HallModel symmetric{.doors_open = 1, .people = 0, .symmetric = true};
  const Town hall = plan_hall(symmetric, 6, 6);
  const auto one = ranges_of(hall, 1, 0), turned = ranges_of(hall, -1, 0);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], turned[i], 1e-6);
  const Town usual = plan_hall({.doors_open = 1, .people = 0}, 6, 6);
  const auto a = ranges_of(usual, 1, 0), b = ranges_of(usual, -1, 0);
  EXPECT_GT(std::ranges::count_if(
                a, [&, i = std::size_t{0}](double r) mutable { return std::abs(r - b[i++]) > 0.1; }),
            20);
}

TEST(Town, PeopleWalkToAndFro) {
  const TownPost person{.at = {0, 0}, .radius = 0.2, .to = {10, 0}, .speed = 1};
  EXPECT_NEAR(person.at_time(4).x(), 4, 1e-9);
  EXPECT_NEAR(person.at_time(14).x(), 6, 1e-9);
  EXPECT_NEAR(person.at_time(24).x(), 4, 1e-9);
}

TEST(Town, DrivesAreDeterministicAndFollowTheirPath) {
  const Town town = plan_hall({.length = 14, .width = 10, .pillars = 2}, 7, 7);
  DriveSettings settings = town_settings();
  settings.laser.every = 5;
  const TownDrive drive = drive_through(town, settings, 7), again = drive_through(town, settings, 7);
  EXPECT_EQ(drive.log, again.log);
  EXPECT_NE(drive.log, drive_through(town, settings, 8).log);
  EXPECT_NEAR(drive.distance, 2 * 2 * (14 + 10), 12);  // two rounds whose corners are cut
  EXPECT_THAT(drive.log, HasSubstr(R"("kind":"laser")"));
}

TEST(Town, AScenarioIsOnePlace) {
  try {
    read_scenario(R"({"waymark_scenario": 1, "street": {}, "hall": {}})", "both.json");
    FAIL() << "nothing was refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("several of the sections forest, street and hall"));
  }
  const Scenario hall = read_scenario(R"({"waymark_scenario": 1, "hall": {"doors_open": 0.2}})", "hall.json");
  EXPECT_TRUE(hall.hall.on);
  EXPECT_EQ(hall.hall.doors_open, 0.2);
  EXPECT_EQ(scenario_json(read_scenario(scenario_json(hall), "again")), scenario_json(hall));
}

}  // namespace
}  // namespace waymark::test

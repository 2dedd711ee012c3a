// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <numbers>

#include "core/random.hpp"
#include "localization/global/horizon_viewpoint.hpp"
#include "localization/global/skyline_index.hpp"
namespace waymark::test {
using namespace localization;
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Cones and a long ridge on a plain, with a hole of unknown terrain.
struct Hills {
  std::vector<SkylineSummit> summits;
  explicit Hills(std::uint64_t seed) {
    Random random(seed, "hills");
    for (int i = 0; i < 25; ++i) {
      const double height = random.uniform(150, 700);
      summits.push_back({{random.uniform(0, 16000), random.uniform(0, 16000)}, height, height, 0});
    }
  }
  std::optional<double> operator()(const Eigen::Vector2d& p) const {
    if (p.x() < 0 || p.y() < 0 || p.x() > 16000 || p.y() > 16000) return {};
    if ((p - Eigen::Vector2d(300, 300)).norm() < 150) return {};
    double height = 0.001 * p.x();
    for (const SkylineSummit& s : summits) height = std::max(height, s.height - 0.35 * (p - s.at).norm());
    return std::max(height, 120 - 0.2 * std::abs(p.y() - 3000 - 0.3 * p.x()));
  }
};

Eigen::AlignedBox2d box(const Hills& hills) {
  Eigen::AlignedBox2d b;
  for (const SkylineSummit& s : hills.summits) b.extend(s.at);
  return b;
}

SkylineOptions moon() {
  SkylineOptions o{.body_radius = 1737400};
  o.position_sd = o.height_sd = 5;
  return o;
}

/// The slow twin: every tenth of a cell, heights of the terrain itself.
double rise_by_marching(const Hills& hills, const Eigen::Vector2d& at, double eye, double azimuth,
                        const SkylineOptions& o, double from) {
  double best = -1e9;
  for (double t = from; t < 23000; t += 6)
    if (const auto h = hills(at + t * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth))))
      best = std::max(best, (*h - curvature_drop(t, o.body_radius, o.refraction) - eye) / t);
  return best;
}

TEST(TerrainGrid, HoldsAllKnownGroundAndItsHighest) {
  const Hills hills(1);
  const TerrainGrid grid(hills, box(hills), 50000);
  // Widened to where the ground ends, from the box of the summits.
  EXPECT_LT((grid.area().min() - Eigen::Vector2d(0, 0)).norm(), 1500);
  EXPECT_LT((grid.area().max() - Eigen::Vector2d(16000, 16000)).norm(), 1500);
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d p(random.uniform(1500, 14500), random.uniform(1500, 14500));
    EXPECT_NEAR(grid.height(p.x(), p.y()), *hills(p), 0.4 * grid.cell());
    const int level = static_cast<int>(random.uniform_index(static_cast<std::uint64_t>(grid.levels())));
    // The block of a level is no lower than the ground at the place itself.
    EXPECT_GE(double(grid.highest(p.x(), p.y(), level)), *hills(p) - 0.8 * grid.cell());
    EXPECT_LE(double(grid.highest(p.x(), p.y(), level)), grid.summit());
  }
  EXPECT_TRUE(std::isnan(grid.height(-9000, 100)));
  EXPECT_EQ(grid.highest(-9000, 100, 0), TerrainGrid::kNone);
  EXPECT_TRUE(TerrainGrid(hills, {}, 100).area().isEmpty());
}

/// A plain below a plateau in the east; holes of 300 m in the plain and in the edge of the plateau; sea
/// without data in the west.
std::optional<double> plateau_with_holes(const Eigen::Vector2d& p) {
  if (p.x() < 1000 || p.y() < 0 || p.x() > 10000 || p.y() > 10000) return {};
  for (const double x : {5000, 8300})
    if ((p - Eigen::Vector2d(x, 5000)).norm() < 150) return {};
  return std::clamp(0.5 * (p.x() - 8000), 0.0, 150.0);
}

const Eigen::AlignedBox2d kAllGround(Eigen::Vector2d(0, 0), Eigen::Vector2d(10000, 10000));

TEST(TerrainGrid, HolesAreFilledAndSeaIsNot) {
  const TerrainGrid grid(plateau_with_holes, kAllGround, 0, 200);
  const TerrainGrid::Sample hole = grid.surface(8300, 5000);
  EXPECT_TRUE(std::isnan(grid.height(8300, 5000)));
  EXPECT_GT(hole.gap, 100);
  EXPECT_LT(hole.gap, 250);
  EXPECT_NEAR(hole.height, 120, 30);
  EXPECT_TRUE(std::isnan(grid.surface(500, 5000).height));
  EXPECT_EQ(grid.surface(3000, 5000).gap, 0);
}

TEST(Horizon, IsUnknownWhereAHoleMayHideIt) {
  const TerrainGrid grid(plateau_with_holes, kAllGround, 0, 200);
  const SkylineOptions o{.body_radius = 0, .refraction = 0};
  // What may stand in the hole of the plateau is higher than the plateau behind it; in that of the plain it
  // is lower.
  EXPECT_FALSE(horizon_at(grid, {7000, 5000}, 2, 0, o).is_known());
  EXPECT_TRUE(horizon_at(grid, {7000, 5000}, 2, 0.5, o).is_known());
  EXPECT_TRUE(horizon_at(grid, {2000, 4700}, 2, 0.1, o).is_known());
  EXPECT_EQ(horizon_at(grid, {2000, 4700}, 2, 0.1, o).possible > 0, true);
}

TEST(Horizon, IsThatOfTheTwin) {
  const SkylineOptions o = moon();
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const Hills hills(seed);
    const TerrainGrid grid(hills, box(hills), 50000);
    Random random(seed, "places");
    const Eigen::Vector2d at(random.uniform(3000, 13000), random.uniform(3000, 13000));
    const double eye = *hills(at) + 2;
    constexpr int kFine = 4;       // directions of the twin per sector
    constexpr double kNear = 300;  // m: nearer ground is wider than a sector
    const auto ring = horizon_ring(grid, at, eye, kNear, 180, o);
    std::vector<double> rise;
    for (int k = 0; k < 180 * kFine; ++k)
      rise.push_back(rise_by_marching(hills, at, eye, (k + 0.5) * kTurn / (180 * kFine), o, kNear));
    for (int k = 0; k < 180 * kFine; k += 3) {
      const double azimuth = (k + 0.5) * kTurn / (180 * kFine);
      // Bilinear cells take off the tip of a cone, and steps of a cell may pass over it.
      EXPECT_NEAR(double(horizon_at(grid, at, eye, azimuth, o).rise),
                  rise_by_marching(hills, at, eye, azimuth, o, 15), 0.35 * 2 * grid.cell() / 200)
          << seed << ' ' << k;
    }
    for (int k = 0; k < 180; ++k) {
      double highest = -1e9, middle = -1e9;
      for (int j = -2 * kFine; j < 3 * kFine; ++j)
        highest = std::max(highest, rise[static_cast<std::size_t>((kFine * k + j + 720) % 720)]);
      for (int j = 1; j < 3; ++j) middle = std::max(middle, rise[static_cast<std::size_t>(kFine * k + j)]);
      // No lower than in the sector's middle, but for a tip between two blocks; no higher than two sectors
      // round it, as blocks are up to a sector wide and begin up to half of that nearer.
      const double rim = double(ring[static_cast<std::size_t>(k)].rise);
      EXPECT_GT(rim, middle - 0.35 * 2 * grid.cell() / kNear) << seed << ' ' << k;
      EXPECT_LT(rim, highest + 0.35 * 2 * grid.cell() / kNear + 0.05 * std::abs(highest)) << seed << ' ' << k;
    }
  }
}

std::vector<HorizonTop> tops_at(const TerrainGrid& grid, const Pose2& robot, const SkylineOptions& o) {
  std::vector<double> rise;
  const double eye = grid.height(robot.x, robot.y) + o.eye;
  for (int k = 0; k < 1800; ++k)
    rise.push_back(double(horizon_at(grid, robot.at(), eye, k * kTurn / 1800, o).rise));
  std::vector<HorizonTop> tops;
  const auto at = [&](int k) { return rise[static_cast<std::size_t>((k + 1800) % 1800)]; };
  for (int k = 0; k < 1800; ++k) {
    bool top = true;
    for (int j = 1; j <= 12; ++j) top = top && at(k) > at(k + j) && at(k) > at(k - j);
    if (top)
      tops.push_back({.bearing = wrap_angle(k * kTurn / 1800 - robot.yaw), .elevation = std::atan(at(k))});
  }
  return tops;
}

TEST(Skyline, IsFoundWhateverTheHeadingAndNumberOfThreads) {
  const Hills hills(7);
  const SkylineOptions o = moon();
  const TerrainGrid grid(hills, box(hills), 50000);
  const SkylineIndex index(hills.summits, hills, o);
  const Pose2 robot{7300, 9100, 0.4};
  for (const double turn : {0.0, -2.9}) {
    const Pose2 turned{robot.x, robot.y, wrap_angle(robot.yaw + turn)};
    const auto tops = tops_at(grid, turned, o);
    ASSERT_GE(tops.size(), 6u);
    const SkylineAnswer one = index.find(tops);
    ASSERT_TRUE(one.fix) << one.reason;
    EXPECT_LT((one.fix->at.pose.at() - robot.at()).norm(), 30);
    EXPECT_NEAR(wrap_angle(one.fix->at.pose.yaw - turned.yaw), 0, 0.01);
    // Cones are summits of the map: most tops have their name.
    const auto named = std::ranges::count_if(one.fix->summits, [](const auto& s) { return s.has_value(); });
    EXPECT_GT(2 * named, one.fix->matched);
    if (turn != 0) continue;
    SkylineAnswer alone;
    tbb::task_arena(1).execute([&] { alone = index.find(tops); });
    ASSERT_TRUE(alone.fix);
    EXPECT_EQ(one.fix->at.pose, alone.fix->at.pose);
    EXPECT_EQ(one.fix->log_false_alarms, alone.fix->log_false_alarms);
    // With a compass, the same place; with one that points elsewhere, no other.
    const auto right = index.find(tops, turned.yaw), wrong = index.find(tops, wrap_angle(turned.yaw + 1.5));
    ASSERT_TRUE(right.fix);
    EXPECT_LT((right.fix->at.pose.at() - robot.at()).norm(), 30);
    EXPECT_FALSE(wrong.fix);
  }
}

TEST(Skyline, WhatIsNoHorizonIsNotFound) {
  const Hills hills(7), elsewhere(8);
  const SkylineOptions o = moon();
  const TerrainGrid there(elsewhere, box(elsewhere), 50000);
  const SkylineIndex index(hills.summits, hills, o);
  Random random(3);
  for (int i = 0; i < 3; ++i) {
    const Pose2 robot{random.uniform(4000, 12000), random.uniform(4000, 12000), random.uniform(-3, 3)};
    EXPECT_FALSE(index.find(tops_at(there, robot, o)).fix) << i;
  }
  auto tops = tops_at(there, {8000, 8000, 0}, o);
  const double nan = std::nan("");
  for (HorizonTop& t : tops) t.elevation = nan;
  EXPECT_EQ(index.find(tops).reason, "too few tops on the horizon");
  for (HorizonTop& t : tops) t = {.bearing = nan, .elevation = 0.1};
  EXPECT_EQ(index.find(tops).reason, "too few tops on the horizon");
  for (HorizonTop& t : tops) t = {.bearing = 1, .elevation = {}};
  EXPECT_EQ(index.find(tops).reason, "too few tops on the horizon");
  // Ground that is nowhere known.
  const TerrainHeight none = [](const Eigen::Vector2d&) { return std::nullopt; };
  const std::vector<HorizonTop> some(5, {.bearing = 1, .elevation = 0.1});
  EXPECT_EQ(find_by_skyline(some, hills.summits, none, o).reason, "no position has such a horizon");
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// Detectors of rovers and harvesters on scans whose truth is known.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "localization/detectors/laser_rocks.hpp"
#include "localization/detectors/laser_stems.hpp"
#include "localization/harvested_trees.hpp"
#include "testbed/drive/laser_scanner.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

Terrain flat(double side = 120) {
  Grid<float> heights(61, 61, 0.0F);
  return {std::move(heights), -side / 2, side / 2, side / 60, side / 60};
}

// 500 stems per hectare, none within 1.5 m of another.
std::vector<StandingTree> stand(double side, double per_hectare, std::uint64_t seed) {
  Random random(seed, "stand");
  std::vector<StandingTree> trees;
  const auto wanted = static_cast<std::size_t>(per_hectare * side * side / 1e4);
  for (int tries = 0; trees.size() < wanted && tries < 100000; ++tries) {
    const Eigen::Vector2d at(random.uniform(-side / 2, side / 2), random.uniform(-side / 2, side / 2));
    bool free = at.norm() > 3;
    for (const StandingTree& t : trees) free = free && (t.foot.head<2>() - at).norm() > 1.5;
    if (free)
      trees.push_back({.foot = {at.x(), at.y(), 0},
                       .height = 20,
                       .dbh = random.uniform(0.12, 0.45),
                       .crown_diameter = 4,
                       .crown_base = 9});
  }
  return trees;
}

struct StemScore {
  double squares = 0, bias = 0, position = 0;
  int stems = 0, found = 0, visible = 0, is_false = 0;
};

// Unoccluded stems: all rays across the central nine tenths of the stem hit it.
bool plainly_visible(const RayFan& fan, const StemSolid& stem, std::uint32_t index, double step) {
  const Eigen::Vector2d to = stem.foot.head<2>() - fan.origin().head<2>();
  const double middle = std::atan2(to.y(), to.x()), half = std::asin(0.45 * stem.dbh / to.norm());
  if (2 * half < 3.3 * step) return false;  // fewer than four beams
  for (int k = -5; k <= 5; ++k) {
    const double a = middle + half * k / 5;
    const auto hit = fan.cast({std::cos(a), std::sin(a), 0});
    if (!hit || hit->kind != TargetKind::stem || hit->index != index) return false;
  }
  return true;
}

StemScore score_stems(double from, double to, const ForestClutter& clutter, std::uint64_t seed) {
  StemScore score;
  LaserModel laser{.field = Degrees{360}, .step = Degrees{0.25}};
  const localization::LaserStemOptions options = localization::forest_stem_options();
  for (std::uint64_t k = 0; k < 12; ++k) {
    const auto trees = stand(70, 500, seed + k);
    const Terrain ground = flat();
    ForestSolids solids = forest_solids(trees, clutter, ground, seed + k);
    for (StemSolid& s : solids.stems) s.lean.setZero();  // the scanner looks at 1.3 m
    const LaserTargets targets(ground, {}, solids.stems, solids.thickets);
    const RayFan fan(targets, {0, 0, 1.3}, 30);
    Random random(seed + k, "scan");
    localization::LaserScan scan = sweep(fan, Eigen::Matrix3d::Identity(), laser, random);
    scan.beam_width = to_radians(laser.divergence).value * (1 - 2 * laser.sensitivity);
    const auto found = localization::find_stems(scan, options);
    std::vector<bool> used(found.size());
    for (std::uint32_t i = 0; i < trees.size(); ++i) {
      const Eigen::Vector2d at = trees[i].foot.head<2>();
      if (at.norm() < from || at.norm() > to) continue;
      const bool visible = plainly_visible(fan, solids.stems[i], i, scan.angle_step);
      score.visible += visible;
      for (std::size_t f = 0; f < found.size(); ++f) {
        const Eigen::Vector2d there =
            found[f].range * Eigen::Vector2d(std::cos(found[f].bearing), std::sin(found[f].bearing));
        if ((there - at).norm() > 0.4) continue;
        used[f] = true;
        if (!visible) continue;
        ++score.found;
        score.squares += std::pow(found[f].diameter - trees[i].dbh, 2);
        score.bias += found[f].diameter - trees[i].dbh;
        score.position += (there - at).squaredNorm();
      }
    }
    for (std::size_t f = 0; f < found.size(); ++f)
      if (found[f].range >= from && found[f].range <= to) ++score.stems, score.is_false += !used[f];
  }
  return score;
}

TEST(LaserStems, AreFoundAndMeasuredWithinTwelveMetres) {
  for (const double to : {4.0, 8.0, 12.0, 18.0}) {
    const StemScore s = score_stems(to - 4, to, {}, 100);
    std::printf(
        "%4.0f m: D RMSE %.1f cm, bias %.1f cm, place %.1f cm, %d of %d visible found, %d of %d false\n", to,
        100 * std::sqrt(s.squares / s.found), 100 * s.bias / s.found, 100 * std::sqrt(s.position / s.found),
        s.found, s.visible, s.is_false, s.stems);
  }
  const StemScore at_twelve = score_stems(11, 13, {}, 200);
  EXPECT_LE(std::sqrt(at_twelve.squares / at_twelve.found), 0.025);
  const StemScore ring = score_stems(8, 12, {}, 100);  // one beam from nowhere cuts a stem in two there
  EXPECT_LE(std::sqrt(ring.squares / ring.found), 0.025);
  const StemScore all = score_stems(2, 12, {}, 300);
  EXPECT_GE(all.found, 0.9 * all.visible);
  EXPECT_LE(all.is_false, 0.05 * all.stems);
  EXPECT_GT(all.visible, 100);
}

TEST(LaserStems, AScanOfMissesHasNone) {
  localization::LaserScan scan{.robot_from_sensor = {},
                               .first_angle = -1,
                               .angle_step = 0.01,
                               .ranges = std::vector<float>(200, 0.0F)};
  EXPECT_TRUE(localization::find_stems(scan, localization::forest_stem_options()).empty());
  scan.ranges.clear();
  EXPECT_TRUE(localization::find_stems(scan, localization::forest_stem_options()).empty());
  EXPECT_TRUE(localization::find_rocks(scan, {}).empty());
  scan.ranges.assign(200, std::nanf(""));
  EXPECT_TRUE(localization::find_rocks(scan, {}).empty());
}

TEST(HarvestedTrees, StandWhereTheCraneReaches) {
  localization::Track track;
  for (int i = 0; i < 3; ++i) {
    localization::TrackRow row;
    row.t = i;
    row.at.pose = {double(i), 0, std::numbers::pi / 2};
    row.at.covariance.diagonal() << 0.04, 0.01, 0;
    track.rows.push_back(row);
  }
  const std::vector<localization::FelledReading> felled{
      {.t = -1, .range = 5, .bearing = 0},
      {.t = 1.5, .range = 5, .bearing = 0, .range_sd = 0.1, .diameter = 0.3}};
  const auto trees = localization::harvested_trees(felled, track);
  ASSERT_EQ(trees.size(), 1u) << "nobody knows where the machine stood before the first row";
  EXPECT_NEAR((trees[0].at - Eigen::Vector2d(1, 5)).norm(), 0, 1e-12);
  EXPECT_NEAR(trees[0].covariance(1, 1), 0.01 + 0.01, 1e-9);
}

}  // namespace
}  // namespace waymark::test

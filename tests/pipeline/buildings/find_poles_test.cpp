// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/find_poles.hpp"

#include <gmock/gmock.h>

#include "tests/pipeline/buildings/made_town.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

struct PoleScore {
  int truth = 0, found = 0, matched = 0;
  double error2 = 0, height = 0, nees = 0;
  double recall() const { return double(matched) / truth; }
  double precision() const { return found ? double(matched) / found : 1; }
};

PoleScore score_poles(double density, std::uint64_t first, std::uint64_t last) {
  PoleScore score;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const MadeTown town = made_town(seed);
    const TownCanopy canopy(town, scan_town(town, {.density = density}, seed), density);
    const FoundPoles found = find_poles(canopy, canopy.all(), {});
    score.truth += int(town.poles.size()), score.found += int(found.poles.size());
    for (const DetectedPole& p : found.poles)
      for (const MadePole& truth : town.poles)
        if (const double error = (canopy.in_town(p.at) - truth.at).norm(); error < 0.6) {
          ++score.matched;
          score.error2 += error * error, score.height += p.height - truth.height;
          score.nees += error * error / (p.sd * p.sd + 0.01) / 2;
        }
  }
  std::printf("density %4.0f: recall %.2f precision %.2f rms %.3f m, height %+.2f m, NEES %.2f, %d poles\n",
              density, score.recall(), score.precision(),
              std::sqrt(score.error2 / std::max(1, score.matched)), score.height / std::max(1, score.matched),
              score.nees / std::max(1, score.matched), score.truth);
  return score;
}

// Few returns hit a pole: docs/evaluation has the figures of more densities.
TEST(FindPoles, MadeTownsHaveTheirPolesAtHighDensity) {
  const PoleScore few = score_poles(4, 101, 101), many = score_poles(30, 101, 102);
  EXPECT_LE(few.recall(), 0.3);
  EXPECT_GE(many.recall(), 0.65);
  EXPECT_GE(few.precision(), 0.9);
  EXPECT_GE(many.precision(), 0.9);
  EXPECT_LE(many.nees / many.matched, 1.5);
}

TEST(FindPoles, TheOrderOfReturnsDoesNotMatter) {
  const MadeTown town = made_town(104, 60);
  auto returns = scan_town(town, {.density = 30}, 1);
  const TownCanopy canopy(town, returns, 30);
  std::ranges::reverse(returns);
  const TownCanopy reversed(town, returns, 30);
  const auto a = find_poles(canopy, canopy.all(), {}), b = find_poles(reversed, reversed.all(), {});
  ASSERT_EQ(a.poles.size(), b.poles.size());
  EXPECT_EQ(a.rejected, b.rejected);
  for (std::size_t i = 0; i < a.poles.size(); ++i) EXPECT_EQ(a.poles[i].at, b.poles[i].at);
}

TEST(FindPoles, TilesFindWhatTheWholeDoes) {
  const MadeTown town = made_town(105, 96);
  const TownCanopy canopy(town, scan_town(town, {.density = 30}, 1), 30);
  const auto whole = find_poles(canopy, canopy.all(), {});
  std::vector<Eigen::Vector2d> of_tiles;
  std::map<std::string, std::int64_t> rejected;
  const std::int64_t side = canopy.all().columns / 4 + 1;
  for (std::int64_t r = 0; r < 4; ++r)
    for (std::int64_t c = 0; c < 4; ++c) {
      const auto part = find_poles(canopy, {c * side, r * side, side, side}, {});
      for (const DetectedPole& p : part.poles) of_tiles.push_back(p.at);
      for (const auto& [reason, count] : part.rejected) rejected[reason] += count;
    }
  std::vector<Eigen::Vector2d> all;
  for (const DetectedPole& p : whole.poles) all.push_back(p.at);
  EXPECT_THAT(of_tiles, ::testing::UnorderedElementsAreArray(all));
  EXPECT_EQ(rejected, whole.rejected);
}

}  // namespace
}  // namespace waymark::test

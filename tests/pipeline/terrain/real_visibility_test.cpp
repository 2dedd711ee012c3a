// SPDX-License-Identifier: Apache-2.0
// Expected visibility against viewsheds ray-cast on real tiles.
#include "pipeline/terrain/mountain_tops.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/terrain/shared_data.hpp"
#include "tests/support/viewshed.hpp"

namespace waymark::test {
namespace {

struct Sample {
  std::vector<double> expected, seen;
};

// Summits spread evenly over the logarithm of prominence: 20 per third of an octave, so hills do not drown
// mountains.
Sample sample(const std::string& tile, double range) {
  const auto dem = open_dem({tile}, NodataPolicy::fill);
  const Viewshed viewshed(*dem);
  auto summits = survey(*dem, 512, 20);
  std::mt19937 random(1);
  std::shuffle(summits.begin(), summits.end(), random);
  const auto isolations = isolation_of(summits, *dem);
  const Meters radius{dem->geometry().where.crs.body().mean_radius()};
  std::map<int, int> in_bin;
  Sample sample;
  for (std::size_t i = 0; i < summits.size(); ++i) {
    int& count = in_bin[static_cast<int>(3 * std::log2(summits[i].prominence / 20))];
    if (!isolations[i].metres || count >= 20) continue;
    const std::int64_t columns = dem->geometry().columns;
    const double seen =
        viewshed.seen_from(summits[i].cell % columns, summits[i].cell / columns, range, 300, 7);
    if (std::isnan(seen)) continue;
    ++count;
    sample.seen.push_back(seen);
    sample.expected.push_back(
        pipeline::expected_visibility({summits[i].prominence}, {*isolations[i].metres}, radius, {range}));
  }
  return sample;
}

TEST(Visibility, AgreesInRankWithViewshedsOnRealGround) {
  SKIP_WITHOUT_DEM_DATA();
  Sample all;
  for (const char* tile :
       {"earth/S33W071.tif", "earth/N42E001.tif", "earth/N46E008.tif", "earth/N49W123.tif"}) {
    const Sample one = sample(tile, 10000);
    ASSERT_GT(one.seen.size(), 150u) << tile;
    const double rank = spearman(one.expected, one.seen);
    std::cout << tile << ": " << one.seen.size() << " summits, rank correlation " << rank << "\n";
    // Without any relation it would stay below 2.6 / sqrt(n) in 99 of 100 draws.
    EXPECT_GT(rank, 2.6 / std::sqrt(static_cast<double>(one.seen.size()))) << tile;
    all.expected.insert(all.expected.end(), one.expected.begin(), one.expected.end());
    all.seen.insert(all.seen.end(), one.seen.begin(), one.seen.end());
  }
  double error = 0, mean_seen = 0, mean_expected = 0;
  const double n = static_cast<double>(all.seen.size());
  for (std::size_t i = 0; i < all.seen.size(); ++i) {
    error += (all.seen[i] - all.expected[i]) * (all.seen[i] - all.expected[i]) / n;
    mean_seen += all.seen[i] / n;
    mean_expected += all.expected[i] / n;
  }
  const double rank = spearman(all.expected, all.seen);
  std::cout << "all: rank correlation " << rank << "; mean share seen " << mean_seen << ", expected "
            << mean_expected << ", rms difference " << std::sqrt(error) << "\n";
  EXPECT_GT(rank, 0.25);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// Models that ship are what `waymark train` makes.
#include <gmock/gmock.h>

#include <cstdlib>

#include "pipeline/forest/tree_confidence.hpp"
#include "pipeline/rocks/rock_network.hpp"
#include "workflows/training/train.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

// About ten CPU seconds.
TEST(Train, TreesGiveTheShippedModel) {
  EXPECT_EQ(train({.what = "trees"}).model, as_text(pipeline::built_in_tree_confidence()));
}

TEST(Train, RocksDoNotDependOnThreads) {
  const TrainResult one = train({.what = "rocks", .scenes = 1, .rounds = 1, .threads = 1});
  EXPECT_EQ(one.model, train({.what = "rocks", .scenes = 1, .rounds = 1, .threads = 3}).model);
  const pipeline::RockNetwork network = pipeline::parse_rock_network(one.model, "made");
  EXPECT_EQ(network.units(), 96U);
  EXPECT_GT(network.rock_prior, 0.05F);
  EXPECT_LT(network.rock_prior, 0.95F);
}

// The shipped network was averaged after both halves were rounded to four digits, and so is what is trained.
TEST(Train, RocksGiveTheShippedNetwork) {
  if (std::getenv("WAYMARK_SLOW_TESTS") == nullptr)
    GTEST_SKIP() << "takes about twenty minutes: set WAYMARK_SLOW_TESTS=1 to run it";
  EXPECT_EQ(train({.what = "rocks"}).model, as_text(pipeline::built_in_rock_network()));
}

TEST(Train, ShippedRockNetworkIsTheTextOfItself) {
  const std::string text = as_text(pipeline::built_in_rock_network());
  EXPECT_EQ(as_text(pipeline::parse_rock_network(text, "again")), text);
  EXPECT_EQ(pipeline::parse_rock_network(text, "again"), pipeline::built_in_rock_network());
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// Models that ship are what `waymark train` makes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "pipeline/forest/tree_confidence.hpp"
#include "pipeline/rocks/rock_network.hpp"
#include "tests/support/message_of.hpp"
#include "workflows/training/train.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

// About ten CPU seconds.
TEST(Train, TreesGiveTheShippedModel) {
  EXPECT_EQ(train({.what = "trees"}).model, as_text(pipeline::built_in_tree_confidence()));
}

TEST(Train, RefusesNegativeCounts) {
  const auto refusal = [](const TrainRequest& request) -> std::string {
    return message_of([&] { train(request); });
  };
  EXPECT_THAT(refusal({.what = "rocks", .scenes = -3}),
              testing::HasSubstr("--scenes = -3 is not at least 0"));
  EXPECT_THAT(refusal({.what = "trees", .rounds = -1}),
              testing::HasSubstr("--rounds = -1 is not at least 0"));
}

TEST(Train, RocksDoNotDependOnThreads) {
  const TrainResult one = train({.what = "rocks", .scenes = 1, .rounds = 1, .threads = 1});
  EXPECT_EQ(one.model, train({.what = "rocks", .scenes = 1, .rounds = 1, .threads = 3}).model);
  const pipeline::RockNetwork network = pipeline::parse_rock_network(one.model, "made");
  EXPECT_EQ(network.units(), 96U);
  EXPECT_GT(network.rock_prior, 0.05F);
  EXPECT_LT(network.rock_prior, 0.95F);
}

/// Returns the largest difference of two weights in units of the fourth significant digit of the first.
double digits_apart(const std::vector<float>& shipped, const std::vector<float>& trained) {
  if (shipped.size() != trained.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < shipped.size(); ++i) {
    const double value = std::abs(double(shipped[i]));
    const double unit = value > 0 ? std::pow(10.0, std::floor(std::log10(value) + 1e-9) - 3) : 1e-12;
    most = std::max(most, std::abs(double(trained[i]) - double(shipped[i])) / unit);
  }
  return most;
}

TEST(Train, DigitsAreCounted) {
  EXPECT_NEAR(digits_apart({-0.008022F, 2}, {-0.008021F, 2}), 1, 1e-3);
  EXPECT_NEAR(digits_apart({1.833F}, {1.843F}), 10, 1e-3);
  EXPECT_EQ(digits_apart({1}, {1, 2}), std::numeric_limits<double>::infinity());
}

// Both halves of the network are rounded to four digits. Between two machines the last digit of one weight in
// sixty differed.
TEST(Train, RocksGiveTheShippedNetwork) {
  if (std::getenv("WAYMARK_SLOW_TESTS") == nullptr)
    GTEST_SKIP() << "takes about twelve minutes of processor time: set WAYMARK_SLOW_TESTS=1 to run it";
  const auto trained = pipeline::parse_rock_network(train({.what = "rocks"}).model, "trained");
  const auto& shipped = pipeline::built_in_rock_network();
  EXPECT_FLOAT_EQ(trained.rock_prior, shipped.rock_prior);
  EXPECT_LT(digits_apart(shipped.mean, trained.mean), 1.01);
  EXPECT_LT(digits_apart(shipped.sd, trained.sd), 1.01);
  EXPECT_LT(digits_apart(shipped.hidden, trained.hidden), 1.01);
  EXPECT_LT(digits_apart(shipped.out, trained.out), 1.01);
}

TEST(Train, ShippedRockNetworkIsTheTextOfItself) {
  const std::string text = as_text(pipeline::built_in_rock_network());
  EXPECT_EQ(as_text(pipeline::parse_rock_network(text, "again")), text);
  EXPECT_EQ(pipeline::parse_rock_network(text, "again"), pipeline::built_in_rock_network());
}

}  // namespace
}  // namespace waymark::test

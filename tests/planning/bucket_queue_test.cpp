// SPDX-License-Identifier: Apache-2.0
#include "planning/bucket_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace waymark::test {
namespace {

using namespace planning;

// Keys of searches: they rarely fall below the last one taken, many are equal, some are far beyond.
TEST(BucketQueue, TakesTheOrderOfOneHeap) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    using Pair = std::pair<double, std::uint32_t>;
    std::priority_queue<Pair, std::vector<Pair>, std::greater<>> heap;
    BucketQueue buckets(seed % 3 * 50.0, 0.01 * (1 + seed));
    double last = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      double key = last + 20 * uniform(random) - 1;
      if (i % 4 == 0) key = std::round(key);
      if (i % 100 == 7) key = 1e9 * uniform(random);
      key = std::max(0.0, key);
      heap.emplace(key, i);
      buckets.push({key, i, 2 * i, 3 * i});
      if (i % 3 == 0) continue;
      const QueueEntry first = buckets.pop();
      ASSERT_EQ(Pair(first.key, first.number), heap.top()) << "seed " << seed;
      EXPECT_EQ(first.value, 2 * first.number);
      EXPECT_EQ(first.more, 3 * first.number);
      last = first.key < 1e6 ? first.key : last;
      heap.pop();
    }
    for (; !heap.empty(); heap.pop()) {
      ASSERT_FALSE(buckets.empty());
      ASSERT_EQ(buckets.pop().number, heap.top().second) << "seed " << seed;
    }
    EXPECT_TRUE(buckets.empty());
  }
}

}  // namespace
}  // namespace waymark::test

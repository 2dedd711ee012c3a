// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/block_cache.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
using namespace importers;
namespace {

// Returns a block of 100 bytes that holds its number; counts how often it is decoded.
class BlockCacheTest : public testing::Test {
 protected:
  double decode(BlockCache& cache, std::uint64_t block, std::uint32_t file = 0) {
    const auto found = cache.get({file, block}, [&] {
      ++decoded;
      return Block{std::vector<double>(100 / sizeof(double) + 1, static_cast<double>(block))};
    });
    return std::get<std::vector<double>>(found->cells)[0];
  }
  int decoded = 0;
};

TEST_F(BlockCacheTest, DecodesOnce) {
  BlockCache cache(1000);
  EXPECT_EQ(decode(cache, 7), 7);
  EXPECT_EQ(decode(cache, 7), 7);
  EXPECT_EQ(decoded, 1);
}

TEST_F(BlockCacheTest, DistinguishesFiles) {
  BlockCache cache(1000);
  decode(cache, 7, 0);
  decode(cache, 7, 1);
  EXPECT_EQ(decoded, 2);
}

TEST_F(BlockCacheTest, DropsWhatWasUsedLongestAgo) {
  BlockCache cache(220);  // two blocks
  decode(cache, 1);
  decode(cache, 2);
  decode(cache, 1);
  decode(cache, 3);  // 2 goes
  decode(cache, 1);
  EXPECT_EQ(decoded, 3);
  decode(cache, 2);
  EXPECT_EQ(decoded, 4);
}

TEST_F(BlockCacheTest, ABlockLargerThanTheCacheIsStillServed) {
  BlockCache cache(1);
  EXPECT_EQ(decode(cache, 1), 1);
  EXPECT_EQ(decode(cache, 2), 2);
}

}  // namespace
}  // namespace waymark::test

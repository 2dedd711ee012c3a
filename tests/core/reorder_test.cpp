// SPDX-License-Identifier: Apache-2.0
#include "core/reorder.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

#include "core/random.hpp"

namespace waymark::test {
namespace {

TEST(Reorder, PutsEachItemWhereTheOrderSays) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed, "reorder");
    std::vector<std::uint32_t> order(random.uniform_index(40));
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    std::vector<std::unique_ptr<std::uint32_t>> items;  // moved only
    for (std::uint32_t i = 0; i < order.size(); ++i) items.push_back(std::make_unique<std::uint32_t>(i));
    reorder(items, order);
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(*items[i], order[i]) << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark::test

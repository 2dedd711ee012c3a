// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/relief_pyramid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "pipeline/terrain/codecs.hpp"

namespace waymark::test {
namespace {

using namespace pipeline;

// A block that seems lower than its highest cell would hide the end of an isolation.
TEST(ReliefPyramid, RoundsHeightsUp) {
  for (const double height : {1.0 / 3, -1.0 / 3, 8848.86, -10'935.1, 16'777'217.0, 0.0, 1e-40}) {
    const auto tile =
        std::make_shared<const BlockRelief>(BlockRelief{{0, 0, 2, 1}, {height, kNoHeight}, {0, 1}});
    const ReliefPyramid made({{tile}}, 32, 16);
    const ReliefPyramid read = Codec<ReliefPyramid>::decode(Codec<ReliefPyramid>::encode(made));
    for (const ReliefPyramid* pyramid : {&made, &read}) {
      for (const ReliefPyramid::Block& block : {ReliefPyramid::Block{0, 0, 0}, pyramid->top()}) {
        EXPECT_GE((*pyramid)(block).highest, height);
        EXPECT_LE((*pyramid)(block).highest, height + 2e-7 * std::abs(height) + 1e-44);
      }
      EXPECT_EQ((*pyramid)({0, 1, 0}).highest, kNoHeight);
      EXPECT_TRUE((*pyramid)({0, 1, 0}).voids && (*pyramid)(pyramid->top()).voids);
    }
  }
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "core/random.hpp"

#include <gmock/gmock.h>

namespace waymark::test {
namespace {

TEST(Random, GivesTheNumbersOfThePublishedGenerator) {
  // splitmix64 of 0: the first output of the authors' C code.
  EXPECT_EQ(mix_bits(0), 0xe220a8397b1dcdafu);
  Random random(0), again(0);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.bits(), again.bits());
}

TEST(Random, NamesGiveIndependentStreams) {
  EXPECT_NE(Random(1, "rocks").bits(), Random(1, "craters").bits());
  EXPECT_NE(Random(1, "rocks").bits(), Random(2, "rocks").bits());
  EXPECT_EQ(Random(1, "rocks").bits(), Random(1, "rocks").bits());
}

TEST(Random, DistributionsHaveTheirMoments) {
  constexpr int kDraws = 100000;
  Random random(1, "moments");
  double sum = 0, squares = 0, uniform = 0, few = 0, many = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double n = random.normal();
    sum += n, squares += n * n;
    uniform += random.uniform();
    few += double(random.poisson(2.5));
    many += double(random.poisson(80));
    ASSERT_LT(random.uniform_index(7), 7u);
  }
  // Three standard errors of each mean.
  EXPECT_NEAR(sum / kDraws, 0, 0.01);
  EXPECT_NEAR(squares / kDraws, 1, 0.0135);
  EXPECT_NEAR(uniform / kDraws, 0.5, 0.0028);
  EXPECT_NEAR(few / kDraws, 2.5, 0.015);
  EXPECT_NEAR(many / kDraws, 80, 0.085);
  EXPECT_EQ(random.poisson(0), 0u);
  EXPECT_EQ(random.poisson(-1), 0u);
}

}  // namespace
}  // namespace waymark::test

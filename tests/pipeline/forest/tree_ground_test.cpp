// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_ground.hpp"

#include <gmock/gmock.h>

namespace waymark::test {
using namespace pipeline;
namespace {

TEST(TreeShapes, CountsTreesThatCanStand) {
  TreeShapes seen;
  seen.add(20, 2);    // as narrow as can be
  seen.add(20, 1.9);  // narrower
  seen.add(116, 14);  // Hyperion
  seen.add(130, 20);  // taller than any
  EXPECT_EQ(seen.trees, 4);
  EXPECT_EQ(seen.possible, 2);
  EXPECT_EQ(seen.real_fraction(), 1);  // four trees allow no statement
}

TEST(TreeShapes, WarningGivesTheNumbers) {
  const TreeShapes seen{.trees = 1000, .possible = 200};
  EXPECT_EQ(seen.real_fraction(), 0.02);
  EXPECT_THAT(tree_shapes_warning(seen),
              testing::StartsWith("80 % of 1000 supposed trees are taller than 120 m"));
  EXPECT_THAT(tree_shapes_warning(seen), testing::HasSubstr("at most 2 % count as real"));
}

TEST(CrownColours, OneTreeInTenIsNotGreen) {
  EXPECT_EQ((CrownColours{.green = 90, .other = 10}).real_fraction_of_other(), 1);
  EXPECT_EQ((CrownColours{.green = 0, .other = 2}).real_fraction_of_other(), 1);  // two allow no statement
  EXPECT_NEAR((CrownColours{.green = 0, .other = 40}).real_fraction_of_other(), 2.0 / 40, 1e-12);
  // 720 green trees come with 80 others, 18 standard deviations included.
  EXPECT_NEAR((CrownColours{.green = 720, .other = 280}).real_fraction_of_other(), 98.0 / 280, 1e-12);
}

TEST(CrownColours, WarningGivesTheNumbers) {
  EXPECT_THAT(
      crown_colours_warning({.green = 3, .other = 60}),
      testing::AllOf(testing::StartsWith("3 of 63 supposed crowns"), testing::HasSubstr("the other 60")));
}

TEST(IsVegetation, LeavesAreGreenAndBrightInTheInfrared) {
  EXPECT_TRUE(is_vegetation(0.05, false));
  EXPECT_FALSE(is_vegetation(0.0, false));  // grey
  EXPECT_TRUE(is_vegetation(0.4, true));
  EXPECT_FALSE(is_vegetation(-0.3, true));  // water
}

}  // namespace
}  // namespace waymark::test

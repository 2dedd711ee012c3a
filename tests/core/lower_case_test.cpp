// SPDX-License-Identifier: Apache-2.0
#include "core/lower_case.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
namespace {

TEST(LowerCase, ChangesLettersOfAsciiAlone) {
  EXPECT_EQ(lower_case("A-Z.TIF"), "a-z.tif");
  EXPECT_EQ(lower_case("Grüße ÄÖ"), "grüße ÄÖ");
  EXPECT_EQ(lower_case(""), "");
}

}  // namespace
}  // namespace waymark::test

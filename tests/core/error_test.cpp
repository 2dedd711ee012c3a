// SPDX-License-Identifier: Apache-2.0
#include "core/error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace waymark::test {
namespace {

TEST(Error, SaysWhatWhereAndWhatToDo) {
  const Error error(ErrorCode::input, "cannot read dem.tif", "/data", "check the path");
  EXPECT_STREQ(error.what(), "cannot read dem.tif\n  /data\n  check the path");
  EXPECT_STREQ(Error(ErrorCode::input, "no more").what(), "no more");
}

TEST(Error, ANameWithALineBreakStaysOnItsLine) {
  EXPECT_STREQ(Error(ErrorCode::input, "there is no such file", "de\nm.tif", "check the path").what(),
               "there is no such file\n  de\\nm.tif\n  check the path");
}

TEST(Error, OnlyWrongUsageExitsWithTwo) {
  EXPECT_EQ(exit_code(ErrorCode::usage), 2);
  EXPECT_EQ(exit_code(ErrorCode::input), 1);
  EXPECT_EQ(exit_code(ErrorCode::output), 1);
  EXPECT_EQ(exit_code(ErrorCode::environment), 1);
}

TEST(NearestName, FindsATypingErrorAndNothingElse) {
  const std::vector<std::string> names{"min_height", "max_height", "threads"};
  EXPECT_EQ(nearest_name("min_heigth", names), "min_height");
  EXPECT_EQ(nearest_name("thread", names), "threads");
  EXPECT_EQ(nearest_name("sun", names), "");
}

TEST(EditDistance, CountsEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

}  // namespace
}  // namespace waymark::test

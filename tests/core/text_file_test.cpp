// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace waymark::test {
namespace {

TEST(TextFile, IsReadToItsLastByte) {
  const auto file = std::filesystem::temp_directory_path() / "waymark-text-file";
  for (const std::string& text : {std::string(), std::string("a\r\n\0b\xff", 6), std::string(100'000, 'x')}) {
    std::ofstream(file, std::ios::binary) << text;
    EXPECT_EQ(read_text(file, "this"), text);
  }
  std::filesystem::remove(file);
}

TEST(TextFile, SaysWhatCannotBeRead) {
  const std::string endless(5000, 'x');  // no file system has such a name
  for (const char* file : {"/nowhere/file", "/tmp", endless.c_str()}) try {
      read_text(file, "the table", ErrorCode::usage, "look");
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_EQ(error.problem(), "cannot read the table");
      EXPECT_EQ(error.where(), file);
      EXPECT_EQ(error.hint(), "look");
    }
}

TEST(TextFile, DevicesWithoutEndAreRefused) {
  EXPECT_EQ(read_text("/dev/null", "this"), "");
  try {
    read_text("/dev/zero", "the table", ErrorCode::usage, "look");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_EQ(error.problem(), "cannot read the table: the device does not end");
    EXPECT_EQ(error.where(), "/dev/zero");
    EXPECT_EQ(error.hint(), "look");
  }
}

}  // namespace
}  // namespace waymark::test

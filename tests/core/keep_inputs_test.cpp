// SPDX-License-Identifier: Apache-2.0
#include "core/keep_inputs.hpp"

#include <gmock/gmock.h>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/locked_folder.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(KeepInputs, TheSameFileByAnotherNameIsRefused) {
  const LockedFolder folder(fs::temp_directory_path());
  const std::string file = (folder.path() / "a.tif").string(), other = (folder.path() / "b.tif").string();
  write_file(file, "heights");
  const auto problem = [&](const fs::path& output, const std::vector<std::string>& inputs) -> std::string {
    try {
      keep_inputs(output, inputs);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem(file, {"", other, file}), HasSubstr("the output would replace the input " + file));
  EXPECT_THAT(problem(folder.path() / "." / "a.tif", {file}), HasSubstr("would replace"));
  fs::create_symlink(file, folder.path() / "link.tif");
  EXPECT_THAT(problem(folder.path() / "link.tif", {file}), HasSubstr("would replace"));
  EXPECT_EQ(problem(other, {file}), "");  // it does not exist yet
  EXPECT_EQ(problem("", {file, ""}), "");
  EXPECT_EQ(problem("/vsimem/a.tif", {"https://host/a.tif", "/vsimem/a.tif"}), "");
}

}  // namespace
}  // namespace waymark::test

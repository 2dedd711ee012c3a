// SPDX-License-Identifier: Apache-2.0
// Every file of tests/fuzz/seeds is read, and every file on which a fuzzer found a fault is refused or read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "core/text_file.hpp"
#include "readers.hpp"
#include "tests/support/reader_faults.hpp"

namespace waymark::test {

// Names the parameter of a test; found by the namespace of Reader.
void PrintTo(const Reader& reader, std::ostream* out) {
  *out << reader.name;
}

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  if (!fs::is_directory(folder)) return {};
  std::vector<fs::path> all(fs::directory_iterator(folder), {});
  std::ranges::sort(all);
  return all;
}

class Fuzz : public testing::TestWithParam<Reader> {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/fuzz-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    for (const auto& [name, content] : GetParam().beside) write(name, content);
    ::alarm(60);  // ends a reader that hangs
  }
  void TearDown() override {
    ::alarm(0);
    fs::remove_all(folder_);
  }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  /// Returns what is wrong with how the file is read; `refused` becomes its message if it is refused.
  std::string fault_of(const fs::path& file, std::string& refused) const {
    const std::string path = write(GetParam().file, read_text(file, "the file"));
    try {
      GetParam().read(path);
    } catch (const Error& error) {
      refused = error.what();
      return fault_of_text(error);
    } catch (const std::exception& error) {
      return std::string("a foreign exception: ") + error.what();
    }
    return {};
  }
  fs::path folder_;
};

TEST_P(Fuzz, SeedsAreSound) {
  const auto files = files_in(fs::path(WAYMARK_SOURCE_DIR "/tests/fuzz/seeds") / GetParam().name);
  EXPECT_FALSE(files.empty());
  const bool edits = GetParam().name.starts_with("map_");  // they damage a map
  for (const fs::path& file : files) {
    std::string refused;
    EXPECT_EQ(fault_of(file, refused), "") << file;
    EXPECT_TRUE(edits || refused.empty()) << file << ": " << refused;
  }
}

TEST_P(Fuzz, RegressionsAreGone) {
  for (const fs::path& file :
       files_in(fs::path(WAYMARK_SOURCE_DIR "/tests/fuzz/regressions") / GetParam().name)) {
    std::string refused;
    EXPECT_EQ(fault_of(file, refused), "") << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(readers()),
                         [](const auto& test) { return test.param.name; });

TEST(FuzzFolders, BelongToReaders) {
  std::set<std::string> names;
  for (const Reader& reader : readers()) names.insert(reader.name);
  for (const char* folder : {"/tests/fuzz/seeds", "/tests/fuzz/regressions"})
    for (const fs::path& path : files_in(WAYMARK_SOURCE_DIR + std::string(folder)))
      EXPECT_TRUE(names.contains(path.filename())) << path;
}

}  // namespace
}  // namespace waymark::test

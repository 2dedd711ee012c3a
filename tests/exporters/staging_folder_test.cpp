// SPDX-License-Identifier: Apache-2.0
#include "exporters/staging_folder.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

void put(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

TEST(StagingFolders, ANewShapefileLeavesNoPartOfTheOld) {
  const test::TemporaryFolder folder;
  for (const char* part : {"a.shp", "a.shx", "a.dbf", "a.prj", "a.qix", "a.cpg"}) put(folder / part, "old");
  put(folder / "a.txt", "mine");
  StagingFolder staging(folder / "a.shp");
  for (const char* part : {"a.shp", "a.shx", "a.dbf"}) put(staging.path() / part, "new");
  const auto files = staging.publish();
  EXPECT_THAT(test::names_in(folder.path()),
              ElementsAre(::testing::StartsWith(".waymark-"), "a.dbf", "a.shp", "a.shx", "a.txt"));
  EXPECT_EQ(files.size(), 3U);
  for (const char* part : {"a.shp", "a.shx", "a.dbf"}) EXPECT_EQ(test::content_of(folder / part), "new");
}

// The process is stopped at each of its renames in turn, by a folder that stands in the way of a part.
TEST(StagingFolders, AnInterruptedShapefileHasNoMainFile) {
  for (const std::string blocked : {"a.dbf", "a.prj", "a.shx", "a.shp"}) {
    const test::TemporaryFolder folder;
    for (const char* part : {"a.shp", "a.shx", "a.dbf", "a.prj"}) put(folder / part, "old");
    std::filesystem::remove(folder / blocked);
    std::filesystem::create_directories(folder / blocked / "in the way");
    StagingFolder staging(folder / "a.shp");
    for (const char* part : {"a.shp", "a.shx", "a.dbf", "a.prj"}) put(staging.path() / part, "new");
    EXPECT_NE(test::error_of([&] { staging.publish(); }), "") << blocked;
    EXPECT_FALSE(std::filesystem::is_regular_file(folder / "a.shp")) << blocked;
    for (const char* part : {"a.shx", "a.dbf", "a.prj"})
      if (std::filesystem::is_regular_file(folder / part)) {
        EXPECT_EQ(test::content_of(folder / part), "new");
      }
  }
}

TEST(StagingFolders, OfAKilledRunVanishWithTheNext) {
  const test::TemporaryFolder folder;
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const StagingFolder staging(folder / "a.html");
    put(staging.path() / "a.html", "half");
    if (::write(ready[1], "r", 1) != 1) ::_exit(1);
    ::pause();
  }
  char letter = 0;
  ASSERT_EQ(::read(ready[0], &letter, 1), 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(test::names_in(folder.path()).size(), 1U);
  write_file(folder / "b.html", "whole");
  EXPECT_THAT(test::names_in(folder.path()), ElementsAre("b.html"));
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "core/locked_folder.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <set>
#include <string>

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

class LockedFolders : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/locked-XXXXXX";
    parent_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(parent_); }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(parent_)) all.insert(entry.path().filename());
    return all;
  }
  fs::path parent_;
};

TEST_F(LockedFolders, VanishWithTheirContent) {
  {
    const LockedFolder folder(parent_);
    std::ofstream(folder.path() / "file") << "x";
    EXPECT_EQ(names().size(), 1U);
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(LockedFolders, VanishOnRequestUnlessAbandoned) {
  LockedFolder kept(parent_), dropped(parent_);
  std::ofstream(dropped.path() / "file") << "x";
  kept.abandon();
  remove_own_folders();
  EXPECT_EQ(names(), std::set<std::string>{kept.path().filename()});
  kept.reclaim();
  remove_own_folders();
  EXPECT_TRUE(names().empty());
}

TEST_F(LockedFolders, OfAKilledProcessAreRemovedByTheNext) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const LockedFolder folder(parent_);
    std::ofstream(folder.path() / "half") << "x";
    if (::write(ready[1], "r", 1) != 1) ::_exit(1);
    ::pause();
  }
  char letter = 0;
  ASSERT_EQ(::read(ready[0], &letter, 1), 1);
  { const LockedFolder other(parent_); }
  EXPECT_EQ(names().size(), 1U) << "a living process keeps its folder";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(names().size(), 1U);
  { const LockedFolder next(parent_); }
  EXPECT_TRUE(names().empty());
}

TEST_F(LockedFolders, OthersAreLeftAlone) {
  for (const char* name : {".waymark-backup", ".waymark-12-notes", ".waymark-abcdef", ".waymark-12-abcdef",
                           "waymark-12-h-abcdef"})
    fs::create_directory(parent_ / name);
  { const LockedFolder folder(parent_); }
  EXPECT_EQ(names().size(), 5U);
}

TEST_F(LockedFolders, WithoutAParentThrow) {
  EXPECT_THROW(LockedFolder(parent_ / "nowhere"), fs::filesystem_error);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <thread>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class AtomicFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/atomic-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  static void put(const fs::path& file, std::string_view content) {
    fs::create_directories(file.parent_path());
    ASSERT_EQ(write_aside(file, content), 0) << file;
  }
  /// Content by path in the folder; hidden folders included.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file())
        all[fs::relative(entry.path(), folder_).string()] = read_text(entry.path(), "it");
    return all;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.push_back(entry.path().filename());
    std::ranges::sort(all);
    return all;
  }
  static std::string error_of(const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  /// Runs `work` in a process that is killed when it has called `stop`.
  static void run_and_kill(const auto& work) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      work([&] {
        if (::write(ready[1], "r", 1) != 1) ::_exit(1);
        ::pause();
      });
      ::_exit(1);
    }
    char letter = 0;
    ASSERT_EQ(::read(ready[0], &letter, 1), 1);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }

  fs::path folder_;
};

using Files = std::map<std::string, std::string>;

TEST_F(AtomicFiles, ReplaceTheOldOneWhenCommitted) {
  put(folder_ / "a.txt", "old");
  {
    AtomicFile file(folder_ / "a.txt");
    put(file.path(), "new");
    put(file.path().string() + "-journal", "of a library");
    EXPECT_EQ(read_text(folder_ / "a.txt", "it"), "old");
    file.commit();
  }
  EXPECT_EQ(files(), (Files{{"a.txt", "new"}}));
  EXPECT_EQ(names().size(), 1U);
}

TEST_F(AtomicFiles, LeaveTheOldOneWithoutACommit) {
  put(folder_ / "a.txt", "old");
  {
    const AtomicFile file(folder_ / "a.txt");
    put(file.path(), "half");
  }
  EXPECT_EQ(files(), (Files{{"a.txt", "old"}}));
}

TEST_F(AtomicFiles, OfAKilledProcessAreRemovedByTheNext) {
  run_and_kill([&](const auto& stop) {
    const AtomicFile file(folder_ / "a.txt");
    put(file.path(), "half");
    put(file.path().string() + "-wal", "x");
    stop();
  });
  EXPECT_EQ(files().size(), 2U);
  write_file(folder_ / "b.txt", "whole");
  EXPECT_THAT(names(), ElementsAre("b.txt"));
}

TEST_F(AtomicFiles, KeepPermissionsAndLinks) {
  put(folder_ / "there/a.txt", "old");
  ::chmod((folder_ / "there/a.txt").c_str(), 0640);
  fs::create_symlink("there/a.txt", folder_ / "link");
  write_file(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_text(folder_ / "there/a.txt", "it"), "new");
  EXPECT_EQ(static_cast<int>(fs::status(folder_ / "there/a.txt").permissions()), 0640);
}

TEST_F(AtomicFiles, DoNotReplaceAPipe) {
  const fs::path pipe = folder_ / "pipe.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string got(100, '\0');
  std::thread reader([&] {
    const int file = ::open(pipe.c_str(), O_RDONLY);
    got.resize(static_cast<std::size_t>(::read(file, got.data(), got.size())));
    ::close(file);
  });
  write_file(pipe, "rows");
  reader.join();
  EXPECT_EQ(got, "rows");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(AtomicFiles, SayWhereTheyCannotBe) {
  EXPECT_THAT(error_of([&] { write_file(folder_ / "nowhere/a.txt", "x"); }),
              HasSubstr("cannot write a.txt: its folder does not exist"));
  fs::create_directory(folder_ / "a.txt");
  EXPECT_THAT(error_of([&] { write_file(folder_ / "a.txt", "x"); }), HasSubstr("it is a folder"));
}

TEST_F(AtomicFiles, ErrorsNameTheFinalPath) {
  const Error inside(ErrorCode::output, "full", "/d/.waymark-1-h-abcdef/m.gpkg, table x");
  EXPECT_EQ(with_final_path(inside, "/d/.waymark-1-h-abcdef/m.gpkg", "/d/m.gpkg").where(),
            "/d/m.gpkg, table x");
  const std::string whole = (std::filesystem::current_path() / "d/.waymark-1/m.gpkg-journal").string();
  EXPECT_EQ(
      with_final_path(Error(ErrorCode::output, "full", whole), "d/.waymark-1/m.gpkg", "d/m.gpkg").where(),
      "d/m.gpkg-journal");
  EXPECT_EQ(with_final_path(Error(ErrorCode::output, "full", "/e"), "/d/x", "/d/m").where(), "/e");
}

class AtomicFileSets : public AtomicFiles {
 protected:
  void SetUp() override {
    AtomicFiles::SetUp();
    old_ = {{"a.dbf", "old"},        {"a.prj", "old"},        {"a.qix", "old"},
            {"a.shp", "old"},        {"a.txt", "mine"},       {"g.gdb/table1", "old"},
            {"g.gdb/table2", "old"}, {"images/1.png", "old"}, {"images/2.png", "old"}};
    for (const auto& [name, content] : old_) put(folder_ / name, content);
    new_ = {{"a.dbf", "new"},        {"a.shp", "new"},        {"a.shx", "new"},        {"a.txt", "mine"},
            {"g.gdb/table1", "new"}, {"images/1.png", "new"}, {"images/2.png", "old"}, {"more/b.shp", "new"}};
  }
  static void fill(const AtomicFileSet& set) {
    for (const char* name : {"a.dbf", "a.shp", "a.shx", "g.gdb/table1", "images/1.png", "more/b.shp"})
      put(set.path() / name, "new");
  }
  Files old_, new_;
};

TEST_F(AtomicFileSets, ReplaceDataSetsWholeAndMergeFolders) {
  std::vector<fs::path> paths;
  {
    AtomicFileSet set(folder_, folder_ / "a.shp");
    fill(set);
    paths = set.commit();
  }
  EXPECT_EQ(files(), new_);
  EXPECT_THAT(paths, ElementsAre(folder_ / "a.dbf", folder_ / "a.shp", folder_ / "a.shx", folder_ / "g.gdb",
                                 folder_ / "images", folder_ / "more"));
}

TEST_F(AtomicFileSets, ChangeNothingIfOneFileCannotBeReplaced) {
  for (const std::string blocked : {"a.dbf", "a.shx", "a.shp", "images/1.png"}) {
    fs::remove(folder_ / blocked);
    fs::create_directories(folder_ / blocked / "in the way");
    const Files before = files();
    AtomicFileSet set(folder_, folder_ / "a.shp");
    fill(set);
    EXPECT_THAT(error_of([&] { set.commit(); }), HasSubstr("it is a folder")) << blocked;
    Files after = files();
    std::erase_if(after, [](const auto& file) { return file.first.starts_with(".waymark-"); });
    EXPECT_EQ(after, before) << blocked;
    fs::remove_all(folder_ / blocked);
  }
}

// Processes are killed at times spread over the duration of a commit, which depends on the disk.
TEST_F(AtomicFileSets, KilledInACommitAreFinishedOrDroppedByTheNext) {
  const fs::path start = folder_.string() + "-start";
  fs::copy(folder_, start, fs::copy_options::recursive);
  const auto begin = std::chrono::steady_clock::now();
  {
    AtomicFileSet set(folder_, folder_ / "a.shp");
    fill(set);
    set.commit();
  }
  const double commit =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
  int old_ones = 0, new_ones = 0, half_done = 0;
  constexpr int kKills = 40;
  for (int round = 0; round < kKills; ++round) {
    const double microseconds = round == kKills - 1 ? 1e5 + 20 * commit : 1.2 * commit * round / kKills;
    fs::remove_all(folder_);
    fs::copy(start, folder_, fs::copy_options::recursive);
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      AtomicFileSet set(folder_, folder_ / "a.shp");
      fill(set);
      if (::write(ready[1], "r", 1) != 1) ::_exit(1);
      set.commit();
      ::_exit(0);  // as killed after the commit
    }
    char letter = 0;
    ASSERT_EQ(::read(ready[0], &letter, 1), 1);
    ::close(ready[0]), ::close(ready[1]);
    ::usleep(static_cast<useconds_t>(microseconds));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    Files visible = files();
    std::erase_if(visible, [](const auto& file) { return file.first.starts_with(".waymark-"); });
    half_done += visible != old_ && visible != new_;
    if (visible.contains("a.shp")) {
      EXPECT_TRUE(visible["a.dbf"] == visible["a.shp"]) << "parts of two data sets";
    }
    write_file(folder_ / "next.txt", "");
    Files after = files();
    after.erase("next.txt");
    ASSERT_TRUE(after == old_ || after == new_) << microseconds << " us";
    ++(after == old_ ? old_ones : new_ones);
    for (const std::string& name : names()) EXPECT_FALSE(name.starts_with(".waymark-")) << name;
  }
  RecordProperty("old", old_ones), RecordProperty("new", new_ones), RecordProperty("half done", half_done);
  EXPECT_GT(new_ones, 0);
  fs::remove_all(start);
}

// The state of each step, as a killed process leaves it.
TEST_F(AtomicFileSets, AreFinishedFromEachStep) {
  const std::string dead = ".waymark-999999999-elsewhere-abcdef/";
  const Files start = old_;
  for (const auto& [step, gone, moved] :
       {std::tuple{"ready", std::vector<std::string>{}, std::vector<std::string>{}},
        std::tuple{"ready", std::vector<std::string>{"a.shp", "a.dbf", "a.prj", "a.qix", "g.gdb"},
                   std::vector<std::string>{}},
        std::tuple{"moving", std::vector<std::string>{"a.shp", "a.dbf", "a.prj", "a.qix", "g.gdb"},
                   std::vector<std::string>{"a.dbf", "g.gdb/table1"}}}) {
    fs::remove_all(folder_);
    for (const auto& [name, content] : start) put(folder_ / name, content);
    for (const std::string& name : gone) fs::remove_all(folder_ / name);
    for (const auto& [name, content] : new_) {
      if (content != "new") continue;
      const bool is_moved = std::ranges::count(moved, name) > 0;
      put(folder_ / (is_moved ? name : dead + step + "/" + name), content);
    }
    write_file(folder_ / "next.txt", "");
    Files after = files();
    after.erase("next.txt");
    EXPECT_EQ(after, new_) << step << ", " << moved.size() << " moved";
  }
}

}  // namespace
}  // namespace waymark::test

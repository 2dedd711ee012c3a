// SPDX-License-Identifier: Apache-2.0
// Killed processes, concurrent access, and full disks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "geodb/map_editor.hpp"
#include "geodb/sqlite/sqlite.hpp"
#include "geodb/update_map.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "tests/geodb/map_scenes.hpp"

namespace waymark::test {
using namespace geodb;
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

pid_t in_child(const auto& work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    work();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "in the child: %s\n", e.what());
    ::_exit(1);
  }
  ::_exit(0);
}

/// Kills the child after a delay of up to 60 ms, distributed evenly over the calls.
void kill_after(pid_t child, int step) {
  std::this_thread::sleep_for(std::chrono::microseconds(1 + step * 7919 % 60'000));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

std::ptrdiff_t files_in(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

TEST(Killed, AWriterLeavesTheOldMapOrTheNewOne) {
  const TemporaryFolder folder;
  const MapContents before = scattered({.landmarks = 100}), after = scattered({.landmarks = 3000});
  write_map(folder / "map.gpkg", before);
  const std::string old_bytes = file_bytes(folder / "map.gpkg");
  write_map(folder / "new.gpkg", after);
  const std::string new_bytes = file_bytes(folder / "new.gpkg");
  std::filesystem::remove(folder / "new.gpkg");
  for (int step = 0; step < 40; ++step) {
    kill_after(in_child([&] { write_map(folder / "map.gpkg", after); }), step);
    const std::string bytes = file_bytes(folder / "map.gpkg");
    ASSERT_TRUE(bytes == old_bytes || bytes == new_bytes) << step;
    if (bytes == new_bytes) write_map(folder / "map.gpkg", before);
  }
  write_map(folder / "map.gpkg", before);
  EXPECT_EQ(files_in(folder), 1) << "the next writer removes the files of killed writers";
}

TEST(Killed, AnEditorLeavesTheMapAsItWas) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  for (int step = 0; step < 30; ++step) {
    kill_after(in_child([&] {
                 MapEditor editor = MapEditor::open(folder / "map.gpkg");
                 for (;;)
                   editor.transact([&] {  // removes one, inserts one: always a thousand
                     Landmark landmark = editor.map().query({.limit = 1}).at(0);
                     editor.remove(landmark.uid);
                     landmark.uid += "'";
                     editor.insert(landmark);
                   });
               }),
               step);
    ASSERT_EQ(MapStore::open(folder / "map.gpkg").count(), 1000) << step;
    ASSERT_THAT(validate_map(folder / "map.gpkg"), IsEmpty()) << step;
  }
}

/// Leaves a map whose editor was killed when half of its transaction was in the file: the journal is hot.
void kill_editor(const std::filesystem::path& map) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = in_child([&] {
    const sqlite::Database database(map, sqlite::OpenMode::update);
    database.execute("PRAGMA cache_spill = ON; PRAGMA cache_size = 10; BEGIN IMMEDIATE");
    database.execute(
        "CREATE TABLE half (x); WITH n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 2000) "
        "INSERT INTO half SELECT randomblob(2000) FROM n; UPDATE lamp_post SET uid = uid || 'half'");
    if (::write(ready[1], "r", 1) != 1) ::_exit(1);
    ::pause();
  });
  char letter = 0;
  ASSERT_EQ(::read(ready[0], &letter, 1), 1);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_GT(std::filesystem::file_size(map.string() + "-journal"), 0U);
}

// SQLite finds a journal by its name, and would roll back pages of the old map into the new one.
TEST(Killed, AnEditorsJournalDoesNotDamageTheNextMap) {
  const TemporaryFolder folder;
  const auto map = folder / "map.gpkg";
  write_map(map, scattered({}));
  kill_editor(map);
  write_map(map, scattered({.landmarks = 1500, .seed = 2}));
  EXPECT_EQ(files_in(folder), 1);
  MapEditor::open(map).remove("lp-1");
  EXPECT_THAT(validate_map(map), IsEmpty());
  EXPECT_EQ(MapStore::open(map).count(), 1499);
}

TEST(Killed, AnEditorsJournalIsInTheBackup) {
  const TemporaryFolder folder;
  const auto map = folder / "map.gpkg";
  write_map(map, scattered({}));
  kill_editor(map);
  update_map(map, map, [](MapEditor& editor) {
    editor.remove("lp-1");
    editor.add_run(example_run());
  });
  EXPECT_EQ(MapStore::open(map).count(), 999);
  kill_editor(map);
  restore_map(map);
  EXPECT_THAT(validate_map(map), IsEmpty());
  EXPECT_EQ(MapStore::open(map).count(), 1000);
  EXPECT_EQ(files_in(folder), 1);
}

TEST(Sharing, ReadersWorkDuringWrites) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({}));
  const auto read = [&] {
    for (int i = 0; i < 15; ++i)
      if (MapStore::open(folder / "map.gpkg").query({}).size() != 1000) ::_exit(2);
  };
  const pid_t readers[] = {in_child(read), in_child(read)};
  MapEditor editor = MapEditor::open(folder / "map.gpkg");
  int edits = 0;
  for (const pid_t reader : readers) {
    int status = 0;
    while (::waitpid(reader, &status, WNOHANG) == 0) {
      Landmark landmark = *editor.map().find("lp-" + std::to_string(edits % 1000));
      landmark.position.xyz.x() += 1;
      editor.update(landmark);
      ++edits;
    }
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
  EXPECT_GT(edits, 0);
}

TEST(Sharing, AnOpenReaderRetainsItsMapWhenAnotherReplacesIt) {
  const TemporaryFolder folder;
  write_map(folder / "map.gpkg", scattered({.landmarks = 10}));
  const MapStore old = MapStore::open(folder / "map.gpkg");
  write_map(folder / "map.gpkg", scattered({.landmarks = 20}));
  EXPECT_EQ(old.query({}).size(), 10u);
  EXPECT_EQ(MapStore::open(folder / "map.gpkg").query({}).size(), 20u);
}

TEST(DiskFull, LeavesTheOldMapAndReportsIt) {
  const TemporaryFolder folder;
  const std::filesystem::path disk = folder / "disk";
  std::filesystem::create_directory(disk);
  if (run_program("mount -t tmpfs -o size=1m tmpfs " + disk.string()).exit_code != 0)
    GTEST_SKIP() << "needs the right to mount a small tmpfs";
  std::string message;
  write_map(disk / "map.gpkg", scattered({.landmarks = 100}));
  const std::string before = file_bytes(disk / "map.gpkg");
  try {
    write_map(disk / "map.gpkg", scattered({.landmarks = 20'000}));
  } catch (const Error& error) {
    message = error.what();
    EXPECT_EQ(error.code(), ErrorCode::output);
  }
  const bool kept = file_bytes(disk / "map.gpkg") == before;
  const auto files = std::distance(std::filesystem::directory_iterator(disk), {});
  run_program("umount " + disk.string());
  EXPECT_THAT(message, HasSubstr("the disk is full\n  " + (disk / "map.gpkg").string()));
  EXPECT_TRUE(kept);
  EXPECT_EQ(files, 1);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// Layers of a drive that grow while the log plays.
#include <gmock/gmock.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "made_drive.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using ::testing::HasSubstr;

class LiveLayers : public ::testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_ / "rocks.csv", rocks_csv());
    std::string log = drive_log({.steps = 400});
    for (const char* t : {"120", "160", "200"})
      log +=
          std::string(R"({"kind":"felled","t":)") + t +
          R"(,"range":5,"bearing":0.1,"range_sd":0.1,"bearing_sd":0.01,"features":{"diameter":0.3,"height":20}})"
          "\n";
    write_text(folder_ / "log.jsonl", log);
    ASSERT_EQ(waymark({"import", folder_ / "rocks.csv", "-o", folder_ / "map.gpkg", "--type", "rock",
                       "--map-crs", "local"})
                  .code,
              0);
  }
  std::vector<std::string> localize(const std::string& every) const {
    return {"localize",
            folder_ / "map.gpkg",
            folder_ / "log.jsonl",
            "-o",
            folder_ / "track.csv",
            "--layers",
            folder_ / "map.gpkg",
            "--live",
            every};
  }
  std::int64_t rows(const char* table) const {
    sqlite3* database = nullptr;
    sqlite3_open((folder_ / "map.gpkg").c_str(), &database);
    sqlite3_stmt* statement = nullptr;
    std::int64_t count = -1;
    if (sqlite3_prepare_v2(database, (std::string("SELECT count(*) FROM ") + table).c_str(), -1, &statement,
                           nullptr) == SQLITE_OK &&
        sqlite3_step(statement) == SQLITE_ROW)
      count = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    sqlite3_close(database);
    return count;
  }
  TempFolder folder_;
};

TEST_F(LiveLayers, EndAsThoseOfAWholeRun) {
  const Outcome done = waymark(localize("10"));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(rows("harvested"), 3);
  EXPECT_EQ(rows("track"), 1);
  EXPECT_EQ(waymark({"validate", folder_ / "map.gpkg"}).code, 0);
}

TEST_F(LiveLayers, OfAKilledRunCanBeRead) {
  const pid_t run = start_waymark(localize("0.5"));
  for (int wait = 0; wait < 2000 && rows("track") < 1; ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(run, SIGKILL);
  int status = 0;
  ::waitpid(run, &status, 0);
  EXPECT_EQ(rows("track"), 1);
  const Outcome checked = waymark({"validate", folder_ / "map.gpkg"});
  EXPECT_EQ(checked.code, 0) << checked.out << checked.err;
}

TEST_F(LiveLayers, NeedAFile) {
  const Outcome done = waymark(
      {"localize", folder_ / "map.gpkg", folder_ / "log.jsonl", "-o", folder_ / "track.csv", "--live", "5"});
  EXPECT_EQ(done.code, 2);
  EXPECT_THAT(done.err, HasSubstr("--layers MAP.gpkg --live 10"));
}

}  // namespace
}  // namespace waymark::test

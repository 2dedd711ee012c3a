// SPDX-License-Identifier: Apache-2.0
// Every command that writes replaces its outputs whole, or leaves the older ones as they were.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/faults/faults_fixture.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// Kills, short writes and failing renames per command: 3, 40 in slow tests, or WAYMARK_FAULT_ROUNDS. Twice
/// as many writes fail.
int rounds() {
  const char* given = std::getenv("WAYMARK_FAULT_ROUNDS");
  return given != nullptr ? std::max(1, std::atoi(given)) : is_slow() ? 40 : 3;
}

/// Returns a random call of each of `parts` equal parts of all calls.
std::vector<long> spread(std::mt19937& random, long calls, int parts) {
  std::vector<long> all;
  for (int part = 0; part < parts; ++part) {
    const long from = 1 + calls * part / parts, to = std::max(from, calls * (part + 1) / parts);
    all.push_back(from + static_cast<long>(random()) % (to - from + 1));
  }
  return all;
}

/// Faults while the newer version of the outputs replaces the older one.
class Faults : public FaultyCommand {
 protected:
  void kill() {
    std::mt19937 random(11);
    std::vector<long> all = spread(random, calls_, std::max(1, rounds() - 2));
    all.insert(all.end(), {1, calls_});
    for (const long call : all) {
      restore();
      const std::string when = "killed at call " + std::to_string(call) + " of " + std::to_string(calls_);
      EXPECT_EQ(run(GetParam().newer, at("kill", call)).code, 128 + 9) << when;
      expect_recovery(when);
    }
  }

  /// Returns whether a hidden folder holds a set of files that was being moved: the next run of any command
  /// finishes it.
  static bool is_being_moved(const std::string& path) {
    return fs::exists(path + "/ready") || fs::exists(path + "/moving");
  }

  // Hidden folders do not wait for the next run; only a set of files that was being moved does.
  void interrupt() {
    if (calls_ < 2) return;  // a single rename is done or not
    std::mt19937 random(14);
    for (int round = 0; round < (is_slow() ? rounds() : 1); ++round) {
      restore();
      const long call = 2 + static_cast<long>(random()) % (calls_ - 1);
      const std::string when =
          "interrupted at call " + std::to_string(call) + " of " + std::to_string(calls_);
      const Outcome ended = run(GetParam().newer, at("interrupt", call));
      EXPECT_EQ(ended.code, 128 + 2) << when;
      EXPECT_THAT(ended.err, HasSubstr("error: interrupted; an output")) << when;
      EXPECT_THAT(ended.err, Not(HasSubstr("cannot write"))) << when;
      std::vector<std::string> left = hidden();
      std::erase_if(left, is_being_moved);
      if (!GetParam().edits_map) {
        EXPECT_THAT(left, ::testing::IsEmpty()) << when;
      }
      expect_recovery(when);
    }
  }

  void let_writes_fail() {
    std::mt19937 random(12);
    const char* fault = "once";
    // Most of them end the program early, with the older version.
    for (const long call : spread(random, calls_, 2 * rounds())) {
      restore();
      fault = fault == std::string("full") ? "once" : "full";
      const std::string when =
          std::string(fault) + " at call " + std::to_string(call) + " of " + std::to_string(calls_);
      const Outcome failed = run(GetParam().newer, at(fault, call));
      if (std::ranges::any_of(hidden(), is_being_moved)) write_other();
      expect_whole(when);
      EXPECT_THAT(failed.code, ::testing::AnyOf(0, 1, 3)) << when << ": " << failed.err;
      if (failed.code == 0 && !GetParam().edits_map) {
        EXPECT_EQ(files(), newer_) << when;
      }
      if (failed.code == 1) {
        EXPECT_NE(failed.err, "") << when;
      }
      if (!GetParam().edits_map) {  // SQLite needs its journal until the disk has room to roll it back
        EXPECT_THAT(hidden(), ::testing::IsEmpty()) << when;
      }
      expect_recovery(when);
    }
  }

  // A write may take a part of the bytes only, which is no error: the rest is written by another call.
  void shorten_writes() {
    std::mt19937 random(13);
    for (const long call : spread(random, calls_, rounds())) {
      restore();
      const std::string when = "short at call " + std::to_string(call) + " of " + std::to_string(calls_);
      const Outcome done = run(GetParam().newer, at("short", call));
      expect_whole(when);
      EXPECT_THAT(done.code, ::testing::AnyOf(0, 1, 3)) << when << ": " << done.err;
      if (done.code == 0 && !GetParam().edits_map) {
        EXPECT_EQ(files(), newer_) << when;
      }
      EXPECT_THAT(hidden(), ::testing::IsEmpty()) << when;
    }
  }

  // What could not be read must not be taken for the end of a file.
  void let_reads_fail() {
    // GDAL's readers of these formats, by which exports are checked, repeat a read that fails, forever.
    for (const char* format : {"export_gml", "export_tab", "export_mif"})
      if (GetParam().name == format) return;
    std::mt19937 random(15);
    const char* fault = "reads";
    for (const long call : spread(random, reads_, 4 * rounds())) {
      restore();
      fault = fault == std::string("read") ? "reads" : "read";
      const std::string when =
          std::string(fault) + " " + std::to_string(call) + " of " + std::to_string(reads_);
      const Outcome failed = run(GetParam().newer, at(fault, call));
      EXPECT_THAT(failed.code, ::testing::AnyOf(0, 1, 2, 3)) << when << ": " << failed.err;
      EXPECT_EQ(failed.err.empty(), failed.code == 0) << when << ": " << failed.err;
      // The rest was done, as the message says.
      if (failed.code == 3 || failed.err.find("images have no pose") != std::string::npos) {
        EXPECT_EQ(run(GetParam().newer).code, 0) << when;
        EXPECT_EQ(files(), newer_) << when;
        continue;
      }
      expect_whole(when);
      if (!GetParam().edits_map) {
        EXPECT_TRUE(failed.code != 0 || files() == newer_) << when << ": taken for the end of a file";
        EXPECT_THAT(hidden(), ::testing::IsEmpty()) << when;
      }
      expect_recovery(when);
    }
  }

  // Both write the same; who is later replaces what the other one wrote.
  void run_two_over_a_slow_network() {
    if (GetParam().edits_map) return;
    restore();
    const Outcome both = run_two(GetParam().newer);
    EXPECT_EQ(both.code, 0) << both.err;
    EXPECT_EQ(files(), newer_) << both.err;
    EXPECT_THAT(hidden(), ::testing::IsEmpty());
  }

  void let_renames_fail() {
    const long count = std::min<long>(rounds(), renames_);
    for (int round = 0; round < count; ++round) {
      restore();
      const long call = 1 + renames_ * round / count;
      const std::string when = "rename " + std::to_string(call) + " of " + std::to_string(renames_);
      const Outcome failed = run(GetParam().newer, at("rename", call));
      EXPECT_THAT(failed.code, ::testing::AnyOf(0, 1, 3)) << when << ": " << failed.err;
      if (failed.code != 0) {
        EXPECT_NE(failed.err, "") << when;
      }
      expect_recovery(when, failed.code == 0);
    }
  }
};

TEST_P(Faults, LeaveTheOldOrTheNew) {
  kill();
  interrupt();
  let_writes_fail();
  shorten_writes();
  let_renames_fail();
  let_reads_fail();
  run_two_over_a_slow_network();
}

TEST(FaultCommands, AreAllThatWrite) {
  const auto is_tested = [](const std::string& name) {
    return std::ranges::any_of(commands(), [&](const Command& one) {
      return one.older.starts_with(name + " ") || one.newer.starts_with(name + " ");
    });
  };
  std::istringstream listed(bash("$WAYMARK --help | sed -n 's/^  \\([a-z]\\+\\)  .*/\\1/p'").out);
  int writing = 0;
  for (std::string name; listed >> name;) {
    // The output of a plan is written by its last call, a `run`.
    if (name == "plan") continue;
    if (bash("$WAYMARK " + name + " --help | grep -q -e '^  -o, --output'").code != 0) continue;
    EXPECT_TRUE(is_tested(name)) << name;
    ++writing;
  }
  EXPECT_GT(writing, 20);
}

INSTANTIATE_TEST_SUITE_P(Commands, Faults, ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace waymark::test

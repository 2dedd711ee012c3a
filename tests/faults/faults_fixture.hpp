// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/program.hpp"
#include "tests/faults/fault_commands.hpp"

namespace waymark::test {

/// Size and hash of each file by its path.
using Files = std::map<std::string, std::string>;

inline std::string digest(const std::string& content) {
  return std::to_string(content.size()) + " bytes, " + std::to_string(std::hash<std::string>{}(content));
}

/// Two versions of a command's outputs, in a folder that can be brought back to the older one.
class FaultyCommand : public ::testing::TestWithParam<Command> {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be loaded first";
#endif
    write_inputs(in_);
    std::filesystem::create_directory(out_);
    make_inputs();
    start_ = run_older();
    std::filesystem::copy(out_, kept_, std::filesystem::copy_options::recursive);
    recovered_.insert(state());
    const Outcome done = run(GetParam().newer, "WAYMARK_FAULT=kill WAYMARK_FAULT_COUNT=" + in_ / "count");
    ASSERT_EQ(done.code, 0) << done.err;
    newer_ = files();
    std::istringstream(text_of(in_ / "count")) >> calls_ >> renames_ >> reads_;
    ASSERT_GT(calls_, 0) << "the calls are not seen";
    ASSERT_NE(newer_, start_);
  }

  /// Runs a command with faults; the times and dates in its outputs are fixed.
  Outcome run(std::string line, const std::string& faults = "") const {
    return bash("export SOURCE_DATE_EPOCH=1700000000 OGR_CURRENT_DATE=2026-01-01T00:00:00Z; exec " +
                call(line, faults));
  }
  /// Runs a command twice at the same time, both over a slow network, where they take some 2 s longer.
  Outcome run_two(const std::string& line) const {
    const std::string wait =
        " WAYMARK_FAULT_WAIT=" + std::to_string(std::clamp(4'000'000 / calls_, 1L, 4000L));
    return bash("export SOURCE_DATE_EPOCH=1700000000 OGR_CURRENT_DATE=2026-01-01T00:00:00Z; " +
                call(line, at("slow", 1) + wait) + " & " + call(line, at("slow", 2) + wait) +
                "; second=$?; wait $! && exit $second");
  }
  /// Returns the call of a command for bash.
  std::string call(std::string line, const std::string& faults) const {
    for (const auto& [word, path] :
         {std::pair{std::string("$OUT"), out_.string()},
          std::pair{std::string("$IN"), std::filesystem::canonical(in_.path()).string()}})
      for (std::size_t at; (at = line.find(word)) != std::string::npos;) line.replace(at, word.size(), path);
    const std::string preload =
        faults.empty() ? ""
                       : "LD_PRELOAD=" INJECT_FAULTS " WAYMARK_FAULT_FOLDER=" + out_.string() +
                             " WAYMARK_FAULT_READS=" + out_.parent_path().string() + " " + faults;
    return "env " + preload + " $WAYMARK --threads 1 -q " + line;
  }
  static std::string at(const char* fault, long call) {
    return std::string("WAYMARK_FAULT=") + fault + " WAYMARK_FAULT_AT=" + std::to_string(call);
  }

  /// Outputs by path. Stored results of a run are not outputs.
  Files files() const {
    Files all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out_)) {
      const std::string name = std::filesystem::relative(entry.path(), out_).string();
      if (!entry.is_regular_file() || name.starts_with("work/")) continue;
      // GDAL gives each File Geodatabase other identifiers, and SpatiaLite notes the time.
      const bool differs = name.find(".gdb/") != std::string::npos || name.ends_with(".sqlite");
      all[name] = differs ? std::to_string(entry.file_size()) + " bytes" : digest(text_of(entry.path()));
    }
    return all;
  }
  std::vector<std::string> hidden() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(".") || name.ends_with("-journal") || name.ends_with("-wal"))
        names.push_back(entry.path().string());
    }
    return names;
  }
  /// All files and folders, the hidden ones, too.
  Files state() const {
    Files all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out_))
      all[std::filesystem::relative(entry.path(), out_).string()] =
          entry.is_regular_file() ? digest(text_of(entry.path())) : "a folder";
    return all;
  }
  void restore() const {
    std::filesystem::remove_all(out_);
    std::filesystem::copy(kept_, out_, std::filesystem::copy_options::recursive);
  }
  /// Writes something else into the folder, as the next run of any command does.
  void write_other() const {
    const Outcome other = run("import $IN/few.csv -o $OUT/other.gpkg --type rock --map-crs EPSG:32632");
    ASSERT_EQ(other.code, 0) << other.err;
    std::filesystem::remove(out_ / "other.gpkg");
  }
  void expect_whole(const std::string& when) {
    if (GetParam().edits_map) {
      if (!sound_.insert(state()).second && hidden().empty()) return;
      for (const auto& [name, content] : files())
        if (name.ends_with(".gpkg")) {
          const Outcome checked = run("validate $OUT/" + name);
          EXPECT_EQ(checked.code, 0) << when << ": " << checked.err;
        }
      return;
    }
    const Files now = files();
    std::string changed;
    for (const auto& [name, content] : now) {
      const bool old = start_.contains(name) && start_.at(name) == content;
      if (!old && !(newer_.contains(name) && newer_.at(name) == content)) changed += " " + name;
    }
    EXPECT_EQ(changed, "") << when << ": neither old nor new";
    for (const auto& [name, content] : start_)
      EXPECT_TRUE(now.contains(name) || !newer_.contains(name)) << when << ": " << name << " is gone";
    const std::string& name = GetParam().name;
    const bool is_set = name.starts_with("export_") || name.starts_with("simulate_") || name == "web";
    if (is_set && now != start_) {
      EXPECT_EQ(now, newer_) << when << ": parts of two";
    }
  }

  /// Expects old or new after the next run of any command, and that the same command then succeeds. The
  /// program does the same in the same state, so that is tried once for each state without hidden files.
  void expect_recovery(const std::string& when, bool is_done = false) {
    const bool was_seen = !recovered_.insert(state()).second && hidden().empty();
    if (!was_seen) write_other();  // finishes a set of files that was being moved
    expect_whole(when);
    if (is_done && !GetParam().edits_map) {
      EXPECT_EQ(files(), newer_) << when;
    }
    if (was_seen || !GetParam().can_repeat) return;
    if (!GetParam().edits_map && GetParam().newer.find("--work") == std::string::npos) {
      EXPECT_THAT(hidden(), ::testing::IsEmpty()) << when;
    }
    const Outcome again = run(GetParam().newer);
    EXPECT_EQ(again.code, 0) << when << ": " << again.err;
    if (!GetParam().edits_map) {
      EXPECT_EQ(files(), newer_) << when;
    }
    expect_whole(when + " and run again");
    EXPECT_THAT(hidden(), ::testing::IsEmpty()) << when << " and run again";
  }

  /// Returns a folder in memory where there is one: flushing thousands of files to a disk takes minutes.
  static void use_memory() {
    if (std::filesystem::is_directory("/dev/shm")) ::setenv("TEST_TMPDIR", "/dev/shm", 1);
  }

  void make_inputs() const {
    const std::string &older = GetParam().older, &line = older, both = older + GetParam().newer;
    const bool drive = line.starts_with("localize") || line.starts_with("evaluate") ||
                       line.starts_with("route") || line.starts_with("train sensor");
    if (line.starts_with("reconstruct")) make("simulate $IN/flight.json -o $IN/flight");
    for (const std::string map : {"few", "many"})
      if (!drive && both.find(map + ".gpkg") != std::string::npos)
        make("import $IN/" + map + ".csv -o $IN/" + map + ".gpkg --type rock --map-crs EPSG:32632");
    if (drive) make("import $IN/drive_rocks.csv -o $IN/few.gpkg --type rock --map-crs local");
    if (line.find("trees.gpkg") != std::string::npos)
      make("import $IN/stems.csv -o $IN/trees.gpkg --type tree --map-crs EPSG:32632");
    if (line.starts_with("evaluate"))
      make("localize $IN/few.gpkg $IN/long.jsonl -o $IN/track.csv --method ekf");
    for (const std::string& command : GetParam().inputs) make(command);
    for (const char* map : {"trees.gpkg", "few.gpkg"})
      if (line.find(std::string("$OUT/") + map) != std::string::npos && GetParam().edits_map)
        std::filesystem::copy(in_ / map, out_ / map);
  }
  void make(const std::string& line) const {
    const Outcome done = run(line);
    ASSERT_EQ(done.code, 0) << line << ": " << done.err;
  }
  Files run_older() const {
    make(GetParam().older);
    return files();
  }

  const int memory_ = (use_memory(), 0);
  TempFolder in_;
  std::filesystem::path out_ = std::filesystem::canonical(in_.path()) / "out", kept_ = in_.path() / "kept";
  Files start_, newer_;
  std::set<Files> recovered_;  ///< states of the outputs from which the next runs were tried
  std::set<Files> sound_;      ///< states whose maps were validated
  long calls_ = 0, renames_ = 0, reads_ = 0;
};

}  // namespace waymark::test

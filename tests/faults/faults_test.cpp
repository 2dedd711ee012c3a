// SPDX-License-Identifier: Apache-2.0
// Every command that writes replaces its outputs whole, or leaves the older ones as they were.
#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "tests/apps/made_dem.hpp"
#include "tests/apps/made_drive.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

bool is_slow() {
  return std::getenv("WAYMARK_SLOW_TESTS") != nullptr;
}

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

/// A command with two versions, whose outputs go to the folder `out`. $OUT is that folder, $IN that of the
/// inputs.
struct Command {
  std::string name;
  std::string older, newer;
  bool edits_map = false;  ///< SQLite changes a map in place: the older state is kept in a journal
};

void PrintTo(const Command& command, std::ostream* out) {
  *out << command.name;
}

const std::vector<Command>& commands() {
  const auto with = [](const std::string& line, const std::string& older, const std::string& newer) {
    const auto filled = [&](const std::string& by) {
      std::string text = line;
      for (std::size_t at; (at = text.find('%')) != std::string::npos;) text.replace(at, 1, by);
      return text;
    };
    return std::pair{filled(older), filled(newer)};
  };
  static const std::vector<Command> all = [&] {
    std::vector<Command> made;
    const auto add = [&](const std::string& name, const std::string& line, const std::string& older,
                         const std::string& newer, bool edits_map = false) {
      const auto [first, second] = with(line, older, newer);
      made.push_back({name, first, second, edits_map});
    };
    add("import", "import $IN/%.csv -o $OUT/map.gpkg --type rock --map-crs EPSG:32632", "few", "many");
    add("run", "peaks $IN/%.tif -o $OUT/map.gpkg --work $OUT/work --tile-cells 64", "small", "large");
    for (const char* ending :
         {"gpkg", "csv", "geojson", "kml", "shp", "fgb", "gml", "gdb", "tab", "mif", "ods", "xlsx", "sqlite"})
      add(std::string("export_") + ending,
          std::string("export $IN/%.gpkg $OUT/rocks.") + ending + " --overwrite", "few", "many");
    add("report", "report $IN/%.gpkg -o $OUT/report.html", "few", "many");
    add("inventory_csv", "inventory $IN/trees.gpkg --grid % -o $OUT/stands.csv --report $OUT/stands.html",
        "80", "40");
    add("inventory_copy", "inventory $IN/trees.gpkg --grid % -o $OUT/trees.gpkg", "80", "40");
    add("inventory_in_place", "inventory $OUT/trees.gpkg --grid % -o $OUT/trees.gpkg", "80", "40", true);
    add("localize_csv", "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method ekf", "short", "long");
    add("localize_gpkg", "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.gpkg --method ekf", "short",
        "long");
    add("localize_live",
        "localize $OUT/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method ekf --layers $OUT/few.gpkg --live 5",
        "short", "long", true);
    add("slam_map",
        "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method slam --write-map $OUT/map.gpkg",
        "short", "long");
    add("simulate_site", "simulate $IN/site.json -o $OUT --seed %", "1", "2");
    add("simulate_forest", "simulate $IN/forest.json -o $OUT --seed %", "1", "2");
    add("allometry", "allometry fit $IN/%.trees.csv -o $OUT/table.csv", "few", "many");
    if (is_slow()) add("train", "train craters -o $OUT/model.txt --scenes 2 --rounds 1 --seed %", "1", "2");
    add("detect_csv", "detect craters $IN/%.pgm -o $OUT/craters.csv --image-sun-angle 0", "small", "large");
    add("detect_gpkg", "detect craters $IN/%.pgm -o $OUT/craters.gpkg --image-sun-angle 0", "small", "large");
    add("trees", "trees --chm $IN/%.chm.tif -o $OUT/map.gpkg --tile-cells 64", "small", "large");
    add("craters", "craters --dem $IN/%.tif -o $OUT/map.gpkg --with-dem", "small", "large");
    add("hazards",
        "hazards $IN/%.ground.tif -o $OUT/hazard.tif --polygons $OUT/hazard.gpkg --nav2 $OUT/hazard.yaml "
        "--rock-cover 0 --detection-limit 0.5",
        "small", "large");
    for (const char* ending : {"gpkg", "csv", "geojson"})
      add(std::string("route_") + ending,
          std::string("route $IN/few.gpkg --from -10,-10 --to %,20 --sensor horizontal_laser --weight 1 -o "
                      "$OUT/route.") +
              ending,
          "20", "30");
    add("update_map", "localize $OUT/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method slam --update-map",
        "short", "long", true);
    add("reconstruct",
        "reconstruct $IN/flight/images --cameras $IN/flight/truth/cameras.json -o $OUT --until % --threads 1",
        "poses", "dem");
    add("merge", "merge $IN/few.gpkg $IN/%.gpkg -o $OUT/map.gpkg", "few", "many");
    const std::string add_rock = " add --type rock --at % 5200000 --feature radius=0.4";
    add("edit_copy", "edit $IN/few.gpkg" + add_rock + " -o $OUT/map.gpkg", "500800", "500900");
    add("edit_in_place", "edit $OUT/few.gpkg" + add_rock, "500800", "500900", true);
    add("map", "map $IN/%.jsonl -o $OUT/map.gpkg", "short", "long");
    add("observability", "observability $IN/few.gpkg -o $OUT/info.tif --sensor horizontal_laser --cell %",
        "8", "4");
    add("view", "view $IN/%.gpkg -o $OUT/view.html", "few", "many");
    add("web", "web $IN/%.gpkg -o $OUT", "few", "many");
    add("stac", "stac $IN/%.gpkg -o $OUT/item.json", "few", "many");
    add("detect_geojson", "detect craters $IN/%.pgm -o $OUT/craters.geojson --image-sun-angle 0", "small",
        "large");
    add("picture", "evaluate track $IN/track.csv --truth $IN/%.jsonl --picture $OUT/track.svg", "short",
        "long");
    return made;
  }();
  return all;
}

/// Size and hash of each file by its path.
using Files = std::map<std::string, std::string>;

std::string digest(const std::string& content) {
  return std::to_string(content.size()) + " bytes, " + std::to_string(std::hash<std::string>{}(content));
}

/// Writes the inputs of all commands.
void write_inputs(const TempFolder& in) {
  for (const auto& [name, count] : {std::pair{"few", 300}, std::pair{"many", 1500}}) {
    std::string rocks = "x,y,radius\n", trees = "height,dbh_cm,species\n";
    for (int i = 0; i < count; ++i) {
      rocks += std::to_string(500000 + i % 40 * 7) + "," + std::to_string(5200000 + i / 40 * 7) + "," +
               std::to_string(0.2 + i % 50 * 0.05) + "\n";
      trees += std::to_string(8 + i % 20) + "," + std::to_string(10 + i % 20 * 1.5 + i % 3) + ",spruce\n";
    }
    write_text(in / (std::string(name) + ".csv"), rocks);
    write_text(in / (std::string(name) + ".trees.csv"), trees);
  }
  std::string stems = "uid,x,y,height,diameter,crown_diameter\n";
  for (int i = 0; i < 100; ++i)
    stems += "t" + std::to_string(i) + "," + std::to_string(440005 + 10 * (i % 10)) + "," +
             std::to_string(5400005 + 10 * (i / 10)) + ",20,0.3,4\n";
  write_text(in / "stems.csv", stems);
  write_text(in / "drive_rocks.csv", rocks_csv());
  write_text(in / "short.jsonl", drive_log({.steps = 60}));
  write_text(in / "long.jsonl", drive_log({.steps = 120}));
  MadeDem small = hills(150, 120), large = hills(200, 160);
  make_dem(in / "small.tif", small);
  make_dem(in / "large.tif", large);
  write_text(in / "site.json", R"({"waymark_scenario": 1, "crs": "local", "ground": {"cell": 0.5},
    "camera": {"columns": 64, "rows": 64, "field_of_view": 45},
    "flights": [{"name": "descent", "images": 2, "from_east": -5, "from_north": -5, "from_altitude": 40,
      "to_east": 5, "to_north": 5, "to_altitude": 30, "tilt": 4}]})");
  const auto wall = [](int column, int row) { return column == row ? -9999.0 : column < 20 ? 100.0 : 101.0; };
  const auto cones = [](int column, int row) {
    return std::max(0.0, 15 - 2 * std::hypot(column % 20 - 10, row % 20 - 10));
  };
  for (const auto& [name, side] : {std::pair{"small", 60}, std::pair{"large", 100}}) {
    MadeDem ground{.columns = side, .rows = 50, .height = wall};
    ground.geotransform = {500000, 0.5, 0, 5200000, 0, -0.5};
    make_dem(in / (std::string(name) + ".ground.tif"), ground);
    ground.height = cones;
    make_dem(in / (std::string(name) + ".chm.tif"), ground);
  }
  write_text(in / "flight.json", R"({"waymark_scenario": 1, "seed": 3, "ground": {"cell": 0.5},
    "camera": {"columns": 64, "rows": 64, "field_of_view": 60}, "dem": {"cell": 4},
    "flights": [{"images": 3, "lines": 2, "line_spacing": 25, "from_east": -25, "from_north": 12,
      "from_altitude": 90, "to_east": 25, "to_north": 12, "to_altitude": 90, "track_sd": 0.5}]})");
  write_text(in / "forest.json", R"({"waymark_scenario": 1, "crs": "EPSG:32632", "seed": 5,
    "ground": {"cell": 1, "east": 440000, "north": 5400000, "up": 520},
    "forest": {"width": 40, "height": 30, "stands": 2, "density": 300, "cell": 0.5, "pulses": 2, "points": true}})");
  for (const auto& [name, side] : {std::pair{"small", 96}, std::pair{"large", 128}}) {
    std::string pixels;
    for (int i = 0; i < side * side; ++i) {
      const double x = i % side - side / 2.0, y = i / side - side / 2.0, r = std::hypot(x, y);
      pixels += static_cast<char>(static_cast<unsigned char>(110 + (r < 20 ? -x * 4 : 0) + i * 7919 % 5));
    }
    write_text(in / (std::string(name) + ".pgm"),
               "P5 " + std::to_string(side) + " " + std::to_string(side) + " 255\n" + pixels);
  }
}

/// Two versions of a command's outputs, and faults while the newer one replaces the older one.
class Faults : public ::testing::TestWithParam<Command> {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer must be loaded first";
#endif
    write_inputs(in_);
    fs::create_directory(out_);
    make_inputs();
    start_ = run_older();
    fs::copy(out_, kept_, fs::copy_options::recursive);
    recovered_.insert(state());
    const Outcome done = run(GetParam().newer, "WAYMARK_FAULT=kill WAYMARK_FAULT_COUNT=" + in_ / "count");
    ASSERT_EQ(done.code, 0) << done.err;
    newer_ = files();
    std::istringstream(text_of(in_ / "count")) >> calls_ >> renames_;
    ASSERT_GT(calls_, 2) << "the calls are not seen";
    ASSERT_NE(newer_, start_);
  }

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

 private:
  /// Runs a command with faults; the times and dates in its outputs are fixed.
  Outcome run(std::string line, const std::string& faults = "") const {
    for (const auto& [word, path] : {std::pair{std::string("$OUT"), out_.string()},
                                     std::pair{std::string("$IN"), fs::canonical(in_.path()).string()}})
      for (std::size_t at; (at = line.find(word)) != std::string::npos;) line.replace(at, word.size(), path);
    const std::string preload =
        faults.empty() ? ""
                       : "LD_PRELOAD=" INJECT_FAULTS " WAYMARK_FAULT_FOLDER=" + out_.string() + " " + faults;
    return bash("export SOURCE_DATE_EPOCH=1700000000 OGR_CURRENT_DATE=2026-01-01T00:00:00Z; exec env " +
                preload + " $WAYMARK --threads 1 -q " + line);
  }
  static std::string at(const char* fault, long call) {
    return std::string("WAYMARK_FAULT=") + fault + " WAYMARK_FAULT_AT=" + std::to_string(call);
  }

  /// Outputs by path. Stored results of a run are not outputs.
  Files files() const {
    Files all;
    for (const auto& entry : fs::recursive_directory_iterator(out_)) {
      const std::string name = fs::relative(entry.path(), out_).string();
      if (!entry.is_regular_file() || name.starts_with("work/")) continue;
      // GDAL gives each File Geodatabase other identifiers, and SpatiaLite notes the time.
      const bool differs = name.find(".gdb/") != std::string::npos || name.ends_with(".sqlite");
      all[name] = differs ? std::to_string(entry.file_size()) + " bytes" : digest(text_of(entry.path()));
    }
    return all;
  }
  std::vector<std::string> hidden() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(out_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(".") || name.ends_with("-journal") || name.ends_with("-wal"))
        names.push_back(entry.path().string());
    }
    return names;
  }
  /// All files and folders, the hidden ones, too.
  Files state() const {
    Files all;
    for (const auto& entry : fs::recursive_directory_iterator(out_))
      all[fs::relative(entry.path(), out_).string()] =
          entry.is_regular_file() ? digest(text_of(entry.path())) : "a folder";
    return all;
  }
  void restore() const {
    fs::remove_all(out_);
    fs::copy(kept_, out_, fs::copy_options::recursive);
  }
  /// Writes something else into the folder, as the next run of any command does.
  void write_other() const {
    const Outcome other = run("import $IN/few.csv -o $OUT/other.gpkg --type rock --map-crs EPSG:32632");
    ASSERT_EQ(other.code, 0) << other.err;
    fs::remove(out_ / "other.gpkg");
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
    const bool is_set = GetParam().name.starts_with("export_") || GetParam().name.starts_with("simulate_") ||
                        GetParam().name == "web";
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
    if (was_seen) return;
    if (!GetParam().edits_map && GetParam().name != "run") {
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
    if (fs::is_directory("/dev/shm")) ::setenv("TEST_TMPDIR", "/dev/shm", 1);
  }

  void make_inputs() const {
    const std::string &older = GetParam().older, &line = older, both = older + GetParam().newer;
    const bool drive =
        line.starts_with("localize") || line.starts_with("evaluate") || line.starts_with("route");
    if (line.starts_with("reconstruct")) make("simulate $IN/flight.json -o $IN/flight");
    for (const std::string map : {"few", "many"})
      if (!drive && both.find(map + ".gpkg") != std::string::npos)
        make("import $IN/" + map + ".csv -o $IN/" + map + ".gpkg --type rock --map-crs EPSG:32632");
    if (drive) make("import $IN/drive_rocks.csv -o $IN/few.gpkg --type rock --map-crs local");
    if (line.find("trees.gpkg") != std::string::npos)
      make("import $IN/stems.csv -o $IN/trees.gpkg --type tree --map-crs EPSG:32632");
    if (line.starts_with("evaluate"))
      make("localize $IN/few.gpkg $IN/long.jsonl -o $IN/track.csv --method ekf");
    for (const char* map : {"trees.gpkg", "few.gpkg"})
      if (line.find(std::string("$OUT/") + map) != std::string::npos && GetParam().edits_map)
        fs::copy(in_ / map, out_ / map);
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
  fs::path out_ = fs::canonical(in_.path()) / "out", kept_ = in_.path() / "kept";
  Files start_, newer_;
  std::set<Files> recovered_;  ///< states of the outputs from which the next runs were tried
  std::set<Files> sound_;      ///< states whose maps were validated
  long calls_ = 0, renames_ = 0;
};

TEST_P(Faults, LeaveTheOldOrTheNew) {
  kill();
  interrupt();
  let_writes_fail();
  shorten_writes();
  let_renames_fail();
}

INSTANTIATE_TEST_SUITE_P(Commands, Faults, ::testing::ValuesIn(commands()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace waymark::test

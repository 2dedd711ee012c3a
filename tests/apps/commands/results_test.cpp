// SPDX-License-Identifier: Apache-2.0
// `--format json` of every command that has result keys, against its declaration, which is also the reference
// page docs/reference/results-tables.md (docs.stage_pages_match).
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/random.hpp"
#include "tests/apps/made_dem.hpp"
#include "tests/apps/made_drive.hpp"
#include "tests/apps/made_flight.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using ResultObject = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::IsEmpty;

bool fits(const ResultObject& value, const std::string& kind) {
  const auto all = [&](auto test) { return std::ranges::all_of(value, test); };
  if (value.is_null()) return true;
  if (kind == "text") return value.is_string();
  if (kind == "flag") return value.is_boolean();
  if (kind == "integer") return value.is_number_integer();
  if (kind == "number") return value.is_number();
  if (kind == "texts")
    return value.is_array() && all([](const ResultObject& one) { return one.is_string(); });
  if (kind == "counts")
    return value.is_object() && all([](const ResultObject& one) { return one.is_number_integer(); });
  if (kind == "object") return value.is_object();
  if (kind == "objects")
    return value.is_array() && all([](const ResultObject& one) { return one.is_object(); });
  return false;
}

class Results : public testing::Test {
 protected:
  /// Runs a command with `--format json` and returns what it prints, which has the declared keys in order.
  ResultObject result(std::vector<std::string> words) {
    words.insert(words.end(), {words[0] == "export" ? "--summary" : "--format", "json"});
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0) << words[0] << ": " << said.err;
    ResultObject object = ResultObject::parse(said.out, nullptr, false);
    EXPECT_TRUE(object.is_object()) << words[0] << " printed: " << said.out;
    std::vector<std::string> names;
    for (const auto& [name, value] : object.items()) names.push_back(name);
    const ResultObject& keys = declared_.at(words[0]);
    std::vector<std::string> expected;
    for (const ResultObject& key : keys) {
      expected.push_back(key["name"]);
      EXPECT_TRUE(object.contains(expected.back()) && fits(object[expected.back()], key["kind"]))
          << words[0] << ": " << expected.back() << " = "
          << object.value(expected.back(), ResultObject()).dump();
    }
    EXPECT_EQ(names, expected) << words[0];
    seen_.insert(keys);
    return object;
  }

  std::string import_table(const std::string& name, const std::string& table, const std::string& type,
                           const std::string& crs = "local") {
    write_text(folder_ / (name + ".csv"), table);
    const std::string map = folder_ / (name + ".gpkg");
    const ResultObject made =
        result({"import", folder_ / (name + ".csv"), "--type", type, "--map-crs", crs, "-o", map});
    EXPECT_EQ(made["map"], map);
    return map;
  }

  void check_import() {
    write_text(folder_ / "bad.csv", "x,y,radius\n1,2,0.5\n3,,0.5\n4,5,-7\n");
    const ResultObject made = result(
        {"import", folder_ / "bad.csv", "--type", "rock", "--map-crs", "local", "-o", folder_ / "bad.gpkg"});
    EXPECT_EQ(made["landmarks"], 1);
    EXPECT_EQ(made["rows"], 3);
    EXPECT_EQ(made["rejected"].size(), 2u);
    EXPECT_EQ(made["types"], ResultObject({"rock"}));
    EXPECT_THAT(made["first_rejection"].get<std::string>(), HasSubstr("bad.csv"));
  }

  void check_merge_and_edit() {
    const std::string a = import_table("a", "uid,x,y,radius\nr1,10,20,0.5\nr2,30,20,0.8\n", "rock");
    const std::string b = import_table("b", "uid,x,y,radius\nr3,50,20,0.6\n", "rock");
    const ResultObject merged = result({"merge", a, b, "-o", folder_ / "ab.gpkg"});
    EXPECT_EQ(merged["maps"], 2);
    EXPECT_EQ(merged["landmarks"], 3);
    EXPECT_EQ(merged["identical"], 0);
    const ResultObject edited = result({"edit", folder_ / "ab.gpkg", "reject", "r1", "r3"});
    EXPECT_EQ(edited["action"], "reject");
    EXPECT_EQ(edited["landmarks"], ResultObject({"r1", "r3"}));
    const ResultObject restored = result({"restore", folder_ / "ab.gpkg"});
    EXPECT_EQ(restored["map"], folder_ / "ab.gpkg");
    EXPECT_FALSE(std::filesystem::exists(restored["backup"].get<std::string>()));
    EXPECT_THAT(waymark({"query", folder_ / "ab.gpkg", "--format", "csv"}).out, HasSubstr("r3,"));
  }

  /// A drive among rocks: a map made of it, a page, a sensor, routes and where its landmarks localize.
  void check_drives() {
    const std::string map = import_table("plain", rocks_csv(), "rock");
    const std::string log = folder_ / "plain.jsonl";
    write_text(log, drive_log({.named = true}));
    const ResultObject made = result({"map", log, "-o", folder_ / "made.gpkg"});
    EXPECT_EQ(made["crs"], "local");
    EXPECT_GT(made["landmarks"]["rock"], 5);
    EXPECT_GT(made["sightings"], made["looks"]);
    const ResultObject page = result({"view", map, "--log", log, "-o", folder_ / "v.html"});
    EXPECT_EQ(page["bytes"], std::filesystem::file_size(folder_ / "v.html"));
    EXPECT_EQ(page["landmarks"]["rock"], made_rocks().size());
    EXPECT_EQ(page["tracks"], 1);
    const ResultObject sensor = result({"train", "sensor", log, "--map", map, "-o", folder_ / "mine.json"});
    EXPECT_EQ(sensor["what"], "sensor");
    EXPECT_THAT(sensor["trained_on"].get<std::string>(), HasSubstr("1 log"));
    const ResultObject route =
        result({"route", map, "--from", "0,0", "--to", "8,6", "--sensor", "horizontal_laser", "--limit-sigma",
                "1", "-o", folder_ / "route.csv"});
    const std::string rows = text_of(folder_ / "route.csv");
    EXPECT_EQ(route["routes"][0]["stations"], std::ranges::count(rows, '\n') - 1);
    EXPECT_GE(route["routes"][0]["length_m"], route["lower_bound_m"]);
    EXPECT_GE(route["shortest"]["length_m"], 10);
    const ResultObject info =
        result({"observability", map, "-o", folder_ / "i.tif", "--sensor", "horizontal_laser"});
    EXPECT_GT(info["columns"], 0);
    EXPECT_GT(info["median_sd_m"], 0);
  }

  void check_scenes() {
    write_text(folder_ / "hall.json", R"({"waymark_scenario": 1, "hall": {}})");
    const ResultObject hall = result({"simulate", folder_ / "hall.json", "-o", folder_ / "hall"});
    EXPECT_GT(hall["town_landmarks"], 10);
    EXPECT_EQ(hall["rocks"], 0);
    const auto site = simulate_flight(folder_.path(), {.pixels = 160});
    const std::string cameras = site / "truth/cameras.json", images = site / "images";
    const ResultObject poses =
        result({"reconstruct", images, "--cameras", cameras, "-o", folder_ / "poses", "--until", "poses"});
    EXPECT_EQ(poses["images"], 6);
    EXPECT_TRUE(poses["cells"].is_null() && poses["map"].is_null());
    const ResultObject dem =
        result({"reconstruct", images, "--cameras", cameras, "-o", folder_ / "site", "--until", "dem"});
    EXPECT_GT(dem["measured"], 0);
    EXPECT_GE(dem["cells"], dem["measured"]);
  }

  void check_localize() {
    const std::string map = import_table("rocks", rocks_csv(), "rock");
    const std::string log = folder_ / "log.jsonl", track = folder_ / "track.csv";
    write_text(log, drive_log({.named = true}));
    const ResultObject done = result({"localize", map, log, "-o", track, "--set", "start_sd=0.2"});
    EXPECT_EQ(done["track"], track);
    const std::string rows = text_of(track);
    EXPECT_EQ(done["rows"], std::ranges::count(rows, '\n') - 1);
    EXPECT_GT(done["sightings"]["matched"], 100);
    EXPECT_EQ(done["wrong"], 0);
    EXPECT_EQ(done["identified"], done["sightings"]["matched"]);
    EXPECT_EQ(done["settings"]["start_sd"], 0.2);
    EXPECT_TRUE(done["chi2"].is_null() && done["first_lost_s"].is_null() && done["map"].is_null());
    // What `graph` prints on standard output is in the object.
    const ResultObject graph = result({"localize", map, log, "-o", track, "--method", "graph"});
    EXPECT_GT(graph["residuals"], 100);
    EXPECT_EQ(graph["converged"], true);
    const ResultObject settings = result({"localize", "--settings", "--method", "pf"});
    EXPECT_TRUE(settings["settings"].contains("particles") && settings["track"].is_null());
  }

  void check_files() {
    const std::string map = import_table(
        "site", "uid,x,y,radius,confidence\nr1,10,20,0.5,1\nr2,30,20,0.8,1\n", "rock", "EPSG:32632");
    const ResultObject report =
        result({"report", map, "-o", folder_ / "r.html", "--truth", folder_ / "site.csv"});
    EXPECT_EQ(report["bytes"], std::filesystem::file_size(folder_ / "r.html"));
    EXPECT_EQ(report["checks"][0]["type"], "rock");
    EXPECT_THAT(result({"report", map, "-o", folder_ / "r.html"})["checks"], IsEmpty());
    const ResultObject exported = result({"export", map, folder_ / "e.csv"});
    EXPECT_EQ(exported["by_type"], ResultObject({{"rock", 2}}));
    EXPECT_EQ(exported["crs"], "EPSG:32632");
    EXPECT_EQ(exported["files"], ResultObject({folder_ / "e.csv"}));
    const ResultObject robot = result({"export", map, folder_ / "e.yaml", "-of", "beluga"});
    EXPECT_EQ(robot["landmarks"], 2);
    EXPECT_TRUE(robot["crs"].is_null() && robot["by_type"].is_null());
    const ResultObject item = result({"stac", map, "-o", folder_ / "item.json"});
    EXPECT_EQ(item["items"], ResultObject({folder_ / "item.json"}));
    EXPECT_TRUE(item["collection"].is_null());
    const ResultObject records = result({"stac", map, "-o", folder_ / "catalogue"});
    EXPECT_EQ(records["items"], ResultObject({folder_ / "catalogue/site.json"}));
    EXPECT_EQ(records["id"], "catalogue");
    const ResultObject web = result({"web", map, "-o", folder_ / "web", "--max-zoom", "3"});
    EXPECT_EQ(web["landmarks"], 2);
    EXPECT_EQ(web["max_zoom"], 3);
    EXPECT_EQ(web["has_library"], false);
  }

  void check_hazards_and_peaks() {
    MadeDem dem{.columns = 40, .rows = 40, .geotransform = {500000, 0.5, 0, 5200000, 0, -0.5}};
    dem.height = [](int column, int) { return column < 20 ? 0.0 : 3.0; };
    const std::string file = make_dem(folder_ / "dem.tif", dem);
    const ResultObject hazards = result({"hazards", file, "-o", folder_ / "h.tif", "--rock-cover", "0.1"});
    EXPECT_EQ(hazards["rock_cover"], 0.1);
    EXPECT_GT(hazards["cells"]["hazard"], 0);
    std::int64_t cells = 0;
    for (const auto& [name, count] : hazards["cells"].items()) cells += count.get<std::int64_t>();
    EXPECT_EQ(cells, 40 * 40);
    EXPECT_TRUE(result({"hazards", file, "-o", folder_ / "h.tif"})["rock_cover"].is_null());
    const ResultObject peaks =
        result({"peaks", make_dem(folder_ / "peaks.tif", twin_peaks()), "-o", folder_ / "p.gpkg"});
    EXPECT_EQ(peaks["landmarks"]["mountain_top"], 2);
  }

  void check_tables() {
    const std::string image = make_dem(folder_ / "image.tif", hills(300, 200));
    const ResultObject found =
        result({"detect", "craters", image, "-o", folder_ / "c.csv", "--image-sun-angle", "30"});
    const std::string rows = text_of(folder_ / "c.csv");
    EXPECT_EQ(found["detections"], std::ranges::count(rows, '\n') - 1);
    EXPECT_TRUE(found["light"].is_null());
    std::string trees = "height,dbh\n";
    for (int i = 0; i < 40; ++i)
      trees += std::to_string(10 + i % 20) + "," + std::to_string(12 + i % 20) + "\n";
    write_text(folder_ / "trees.csv", trees);
    const ResultObject fit = result(
        {"allometry", "fit", folder_ / "trees.csv", "-o", folder_ / "table.csv", "--diameter-unit", "cm"});
    EXPECT_EQ(fit["rows"][0]["species"], "all");
    EXPECT_EQ(fit["rows"][0]["tree_count"], 40);
    EXPECT_GT(fit["rows"][0]["b"], 0);
  }

  /// Five detections are too few to be located among 200 craters of the Moon.
  void check_locate() {
    Random random(5, "results of locate");
    std::string craters = "x,y,radius\n", seen = "x,y,diameter\n";
    for (int i = 0; i < 200; ++i)
      craters += std::to_string(random.uniform(-180, 180)) + "," + std::to_string(random.uniform(-80, 80)) +
                 "," + std::to_string(random.uniform(2'000, 50'000)) + "\n";
    for (int i = 0; i < 5; ++i)
      seen += std::to_string(random.uniform(0, 500)) + "," + std::to_string(random.uniform(0, 500)) + "," +
              std::to_string(random.uniform(10, 60)) + "\n";
    write_text(folder_ / "seen.csv", seen);
    const std::string map = import_table("moon", craters, "crater", "IAU_2015:30100");
    const ResultObject found = result({"locate", map, folder_ / "seen.csv", "--size", "500", "500"});
    EXPECT_EQ(found["craters"], 200);
    EXPECT_EQ(found["located"], 0);
    EXPECT_EQ(found["images"][0]["detected"], 5);
  }

  /// A map of all craters of a catalogue, moved by 5 km and turned by a right angle.
  void check_register() {
    Random random(3, "results");
    std::string catalogue = "x,y,diameter\n", rough = "x,y,radius\n";
    for (int i = 0; i < 60; ++i) {
      const double x = random.uniform(0, 8'000), y = random.uniform(0, 8'000), d = random.uniform(200, 2'000);
      const auto text = [](double value) { return std::to_string(value); };
      catalogue += text(600'000 + x) + "," + text(5'200'000 + y) + "," + text(d) + "\n";
      rough += text(5'000 + y) + "," + text(-x) + "," + text(d / 2) + "\n";
    }
    write_text(folder_ / "catalogue.csv", catalogue);
    const std::string map = import_table("rough", rough, "crater");
    const ResultObject placed = result({"register", map, "--to", folder_ / "catalogue.csv", "--crs",
                                        "EPSG:32632", "-o", folder_ / "placed.gpkg"});
    EXPECT_EQ(placed["crs"], "EPSG:32632");
    EXPECT_EQ(placed["agreed"], 60);
    EXPECT_NEAR(placed["scale"], 1, 1e-3);
    EXPECT_NEAR(placed["yaw_deg"], 90, 0.1);
    EXPECT_NEAR(placed["middle_m"]["x"], 604'000, 1'000);
    EXPECT_GT(placed["middle_sd_m"]["y"], 0);
  }

  Results() {
    const ResultObject all = ResultObject::parse(waymark({"help", "--format", "json"}).out);
    for (const ResultObject& command : all["commands"])
      if (!command["result"].empty()) declared_[command["name"]] = command["result"];
  }

  TempFolder folder_;
  std::map<std::string, ResultObject> declared_;
  std::set<ResultObject> seen_;
};

TEST_F(Results, EveryCommandPrintsTheDeclaredKeysAlone) {
  for (const char* command :
       {"localize", "web",     "merge",       "edit",   "stac",   "report",   "hazards",
        "register", "import",  "map",         "view",   "train",  "route",    "observability",
        "simulate", "restore", "reconstruct", "locate", "detect", "allometry"})
    EXPECT_TRUE(declared_.contains(command)) << command;
  check_import();
  check_merge_and_edit();
  check_localize();
  check_files();
  check_hazards_and_peaks();
  check_register();
  check_locate();
  check_drives();
  check_scenes();
  check_tables();
  for (const auto& [command, keys] : declared_)
    EXPECT_TRUE(seen_.contains(keys)) << "no test runs " << command << " --format json";
}

TEST_F(Results, ErrorsKeepTheirExitCodesAndStandardOutputStaysEmpty) {
  const std::string map = import_table("map", "uid,x,y,radius\nr1,10,20,0.5\n", "rock");
  const auto refused = [&](std::vector<std::string> words, int code) {
    const Outcome text = waymark(words);
    words.insert(words.end(), {"--format", "json"});
    const Outcome as_json = waymark(words);
    EXPECT_EQ(as_json.code, code) << as_json.err;
    EXPECT_EQ(text.code, code);
    EXPECT_EQ(as_json.err, text.err);
    EXPECT_EQ(as_json.out, "");
  };
  refused({"merge", map, "-o", folder_ / "m.gpkg"}, 2);
  refused({"edit", map, "reject", "nobody"}, 2);
  refused({"localize", map, folder_ / "none.jsonl", "-o", folder_ / "t.csv"}, 1);
  refused({"import", folder_ / "none.csv", "-o", folder_ / "m.gpkg"}, 1);
  refused({"register", map, "--to", folder_ / "none.csv", "-o", folder_ / "m.gpkg"}, 1);
  refused({"hazards", map, "-o", folder_ / "h.tif"}, 1);
  refused({"report", folder_ / "none.gpkg", "-o", folder_ / "r.html"}, 1);
  refused({"stac", folder_ / "none.gpkg", "-o", folder_ / "s.json"}, 1);
  refused({"web", folder_ / "none.gpkg", "-o", folder_ / "w"}, 1);
  refused({"restore", map}, 1);
  refused({"map", folder_ / "none.jsonl", "-o", folder_ / "m.gpkg"}, 1);
  refused({"view", folder_ / "none.gpkg", "-o", folder_ / "v.html"}, 1);
  refused({"route", map, "--from", "0,0", "--to", "9,9", "--sensor", "horizontal_laser", "-o", "r.csv"}, 2);
  refused({"simulate", folder_ / "none.json", "-o", folder_ / "s"}, 1);
}

}  // namespace
}  // namespace waymark::test

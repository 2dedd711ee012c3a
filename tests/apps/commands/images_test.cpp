// SPDX-License-Identifier: Apache-2.0
// Posed images to landmarks by one command.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/made_flight.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Images : public testing::Test {
 protected:
  Outcome images(std::vector<std::string> words) {
    words.insert(words.begin(), {"images", "-o", map_});
    return waymark(words);
  }
  static std::string rows(const std::string& map, const std::string& type) {
    return waymark({"query", map, "--type", type, "--format", "csv"}).out;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "images.gpkg";
};

TEST_F(Images, GiveTheMapOfTheJob) {
  const auto site = simulate_flight(folder_.path(), {});
  const std::string by_job = folder_ / "job.gpkg";
  ASSERT_EQ(waymark({"run", site / "job.json", "-o", by_job}).code, 0);
  const auto job = nlohmann::json::parse(text_of(site / "job.json"));
  const std::string height_sd = job["stages"][0]["height_sd"].dump();

  const Outcome made = images({site / "images", "--cameras", site / "cameras.json", "--dem", site / "dem.tif",
                               "--crs", "local", "--height-sd", height_sd});
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_THAT(rows(map_, "rock"), HasSubstr("\n"));
  for (const char* type : {"rock", "crater"}) EXPECT_EQ(rows(map_, type), rows(by_job, type)) << type;

  ASSERT_EQ(images({"--cameras", site / "cameras.json", "--dem", site / "dem.tif", "--crs", "local", "--find",
                    "rocks"})
                .code,
            0);
  EXPECT_THAT(waymark({"query", map_, "--format", "csv"}).out, Not(HasSubstr("crater")));
  EXPECT_THAT(rows(map_, "rock"), HasSubstr("rock"));
  const Outcome craters = images(
      {"--cameras", site / "cameras.json", "--dem", site / "dem.tif", "--crs", "local", "--find", "craters"});
  ASSERT_EQ(craters.code, 0) << craters.err;
  EXPECT_THAT(waymark({"query", map_, "--format", "csv"}).out, Not(HasSubstr("rock")));

  const Outcome level = images({site / "images", "--cameras", site / "cameras.json", "--crs", "local"});
  EXPECT_EQ(level.code, 0) << level.err;
}

// Rocks look like small craters under the opposite sun.
TEST_F(Images, RocksDoNotTurnAnUnknownSunRound) {
  write_text(folder_ / "scenario.json", R"({
    "waymark_scenario": 1, "crs": "local", "seed": 805,
    "ground": {"cell": 0.3}, "relief": {"rms": 2, "max_wavelength": 250, "roughness": 0.5},
    "craters": {"density": 0.2, "min_diameter": 4, "max_diameter": 40},
    "rocks": {"k": 0.25, "min_diameter": 0.5, "max_diameter": 4, "clustering": 0.4},
    "picture": {"contrast": 1.2}, "sun": {"azimuth": 185, "elevation": 50},
    "camera": {"columns": 900, "rows": 900, "field_of_view": 50},
    "flights": [{"images": 3, "from_east": 10, "from_north": 10, "from_altitude": 150,
                 "to_east": 30, "to_north": 25, "to_altitude": 120}],
    "dem": {"cell": 1, "height_sd": 0.1}})");
  const std::string site = folder_ / "site";
  ASSERT_EQ(waymark({"simulate", folder_ / "scenario.json", "-o", site}).code, 0);
  auto cameras = nlohmann::json::parse(text_of(site + "/cameras.json"));
  ASSERT_EQ(cameras["images"].size(), 3U);
  cameras.erase("sun");
  for (auto& image : cameras["images"]) image.erase("sun");
  write_text(site + "/no_sun.json", cameras.dump());
  std::map<std::string, double> found;
  for (const char* file : {"cameras.json", "no_sun.json"}) {
    const Outcome made = images({site + "/images", "--cameras", site + "/" + file, "--dem", site + "/dem.tif",
                                 "--crs", "local", "--find", "craters"});
    ASSERT_EQ(made.code, 0) << made.err;
    found[file] = std::stod(bash("sqlite3 " + map_ + " 'SELECT count(*) FROM crater'").out);
  }
  EXPECT_GT(found["cameras.json"], 0);
  EXPECT_LT(found["no_sun.json"], 2 * found["cameras.json"]);
}

TEST_F(Images, RefuseWhatMakesNoJob) {
  for (const auto& [words, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "no images are given"},
           {{"a.png", "--find", "rocks,trees"}, "--find does not know 'trees'"},
           {{"a.png", "--find", "rocks,"}, "--find does not know ''"},
           {{"a.png", "--find", ""}, "--find names no landmarks"},
           {{"a.png", "--find", "mountain_tops"}, "pass --dem"}}) {
    const Outcome said = images(words);
    EXPECT_EQ(said.code, 2) << why;
    EXPECT_THAT(said.err, HasSubstr(why));
  }
  EXPECT_THAT(images({"a.png", "--print-job"}).out, HasSubstr("rocks_from_shadows"));
}

}  // namespace
}  // namespace waymark::test

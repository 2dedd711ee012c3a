// SPDX-License-Identifier: Apache-2.0
// Posed images to landmarks by one command.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "made_flight.hpp"
#include "program.hpp"

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

  const Outcome level = images({site / "images", "--cameras", site / "cameras.json", "--crs", "local"});
  EXPECT_EQ(level.code, 0) << level.err;
}

TEST_F(Images, RefuseWhatMakesNoJob) {
  for (const auto& [words, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "no images are given"},
           {{"a.png", "--find", "rocks,trees"}, "--find does not know 'trees'"},
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

// SPDX-License-Identifier: Apache-2.0
// Maps made from a drive with known poses.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
using testing::AllOf, testing::ElementsAre, testing::Gt, testing::HasSubstr, testing::Pair;
namespace {

// 45 minutes in an office, by an odometry that turns left by 0.06 rad per metre: map of the even minutes,
// judged in the odd ones. A quarter of the drive leads through rooms without a map, which look like others
// that have one.
TEST(RealHall, IntelLabByItsOwnCornersAndEnds) {
  const auto data = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/environments/indoor_intel";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not on this machine";
  TempFolder folder;
  const std::string split = WAYMARK_SOURCE_DIR "/tests/apps/split_minutes.py";
  ASSERT_EQ(std::system(
                ("python3 '" + split + "' '" + data.string() + "' '" + folder.path().string() + "'").c_str()),
            0);
  const std::string map = folder / "office.gpkg", log = folder / "intel.clf", track = folder / "track.csv";
  const Outcome made = waymark({"map", log, "--poses", folder / "even.csv", "-o", map});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const std::string method : {"ekf", "pf"}) {
    const Outcome localized = waymark({"localize", map, log, "-o", track, "--method", method, "--ids",
                                       "unknown", "--start", "0.6003,-0.032,-0.35467,976052890.244"});
    ASSERT_EQ(localized.code, 0) << localized.err;
    const Outcome said =
        waymark({"evaluate", "track", track, "--truth", folder / "odd.csv", "--format", "json"});
    ASSERT_EQ(said.code, 0) << said.err;
    const auto score = nlohmann::json::parse(said.out);
    std::cout << method << ": median " << score["ate_median"] << " m, RMS " << score["ate_rmse"] << " m\n";
    EXPECT_LT(score["ate_median"], 0.08) << method;
    EXPECT_LT(score["ate_rmse"], 0.2) << method;
    EXPECT_LT(score["heading_rmse_deg"], 2.2) << method;
    EXPECT_LT(score["lost"], 0.035) << method;
  }
}

// 2,984 relations of two scans that people checked. The reference poses themselves err by 0.029 m against
// them.
TEST(RealHall, TheGraphOfTheIntelLabFromNothingFitsItsRelations) {
  const auto data = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/environments/indoor_intel";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not on this machine";
  TempFolder folder;
  const std::string log = folder / "intel.clf", track = folder / "track.csv",
                    scripts = WAYMARK_SOURCE_DIR "/tests/apps/";
  ASSERT_EQ(std::system(("python3 '" + scripts + "split_minutes.py' '" + data.string() + "' '" +
                         folder.path().string() + "'")
                            .c_str()),
            0);
  const Outcome made = waymark({"localize", "none", log, "-o", track, "--method", "graph", "--ids", "unknown",
                                "--start", "0.6003,-0.032,-0.35467"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string said = folder / "said.txt";
  ASSERT_EQ(std::system(("python3 '" + scripts + "relation_errors.py' '" + track + "' '" +
                         (data / "intel.relations").string() + "' > '" + said + "'")
                            .c_str()),
            0);
  double count = 0, all = 0, apart = 0;
  std::ifstream(said) >> count >> all >> apart;
  std::cout << count << " relations: mean error " << all << " m, 60 s apart " << apart << " m\n";
  EXPECT_GE(count, 2900);
  EXPECT_LT(all, 0.05);
  EXPECT_LT(apart, 0.07);
}

/// A drive through a short street with a line scanner and a 3-D scanner.
class MadeStreet : public testing::Test {
 protected:
  MadeStreet() {
    write_text(folder_.path() / "street.json",
               R"({"waymark_scenario": 1, "seed": 61, "street": {"length": 40},
                   "drive": {"speed": 2, "scanner": {"on": true}}})");
    EXPECT_EQ(waymark({"simulate", folder_ / "street.json", "-o", folder_ / "drive"}).code, 0);
  }

  /// Returns the numbers of landmarks of a map by the detectors of a list, by type.
  std::map<std::string, int> map_by(const std::string& scans) {
    const Outcome made = waymark({"map", folder_ / "drive/log.jsonl", "--scans", scans, "--max-range", "40",
                                  "-o", folder_ / "street.gpkg", "--format", "json"});
    EXPECT_EQ(made.code, 0) << made.err;
    return nlohmann::json::parse(made.out)["landmarks"];
  }

  TempFolder folder_;
};

TEST_F(MadeStreet, BothScannersHaveDetectorsByName) {
  EXPECT_THAT(map_by("poles_3d"), ElementsAre(Pair("pole", Gt(5))));
  EXPECT_THAT(map_by("facades,curbs"), ElementsAre(Pair("curb", Gt(0)), Pair("wall", Gt(1))));
  const auto of_all = map_by("poles");
  for (const char* type : {"curb", "pole", "wall"}) EXPECT_GT(of_all.count(type), 0) << type;
  EXPECT_THAT(map_by("wall_lines,poles_3d"), ElementsAre(Pair("pole", Gt(5)), Pair("wall", Gt(1))));
  const Outcome refused = waymark(
      {"map", folder_ / "drive/log.jsonl", "--scans", "poles_3d,poels", "-o", folder_ / "street.gpkg"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("there is no detector 'poels' for scans"), HasSubstr("poles_3d"),
                                 HasSubstr("wall_lines")));
}

/// A drive through a small hall, whose scans `change` edits.
class MadeHall : public testing::Test {
 protected:
  MadeHall() {
    write_text(folder_.path() / "hall.json",
               R"({"waymark_scenario": 1, "seed": 5, "hall": {"length": 16, "width": 10, "people": 0}})");
    EXPECT_EQ(waymark({"simulate", folder_ / "hall.json", "-o", folder_ / "hall"}).code, 0);
  }

  std::string log(const std::function<void(nlohmann::json&)>& change) const {
    std::ifstream lines(folder_ / "hall/log.jsonl");
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      auto record = nlohmann::json::parse(line);
      if (record["kind"] == "laser") change(record);
      text += record.dump() + "\n";
    }
    write_text(folder_.path() / "log.jsonl", text);
    return folder_ / "log.jsonl";
  }

  TempFolder folder_;
};

TEST_F(MadeHall, ScansWithLeftAndRightExchangedAreNamed) {
  const std::string right = log([](nlohmann::json&) {});
  const Outcome good = waymark({"map", right, "-o", folder_ / "map.gpkg"});
  EXPECT_EQ(good.code, 0);
  EXPECT_THAT(good.err, testing::Not(testing::HasSubstr("warning")));
  const Outcome said =
      waymark({"map", log([](nlohmann::json& scan) { std::ranges::reverse(scan["ranges"]); }), "-o",
               folder_ / "m.gpkg"});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, testing::HasSubstr("scans fit the poses if left and right are exchanged"));
}

TEST_F(MadeHall, RangesInMillimetresAreNamed) {
  const std::string in_metres = log([](nlohmann::json&) {}), map = folder_ / "map.gpkg";
  ASSERT_EQ(waymark({"map", in_metres, "-o", map}).code, 0);
  const std::string wrong = log([](nlohmann::json& scan) {
    for (auto& range : scan["ranges"])
      if (range.is_number()) range = 1000 * range.get<double>();
  });
  const Outcome mapped = waymark({"map", wrong, "-o", folder_ / "empty.gpkg"});
  EXPECT_THAT(mapped.err, testing::AllOf(testing::HasSubstr("ranges are metres"),
                                         testing::HasSubstr("the map is empty: ")));
  const Outcome localized = waymark({"localize", map, wrong, "-o", folder_ / "track.csv"});
  EXPECT_EQ(localized.code, 0);
  EXPECT_THAT(localized.err, testing::AllOf(testing::HasSubstr("ranges are metres"),
                                            testing::HasSubstr("the track is dead reckoning")));
}

}  // namespace
}  // namespace waymark::test

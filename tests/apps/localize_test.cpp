// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "made_dem.hpp"
#include "made_drive.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Localize : public testing::Test {
 protected:
  void SetUp() override { import_rocks(rocks_csv(), "local"); }

  void import_rocks(const std::string& csv, const std::string& crs) {
    write_text(folder_.path() / "rocks.csv", csv);
    std::filesystem::remove(map_);
    const Outcome said =
        waymark({"import", folder_ / "rocks.csv", "-o", map_, "--type", "rock", "--map-crs", crs});
    ASSERT_EQ(said.code, 0) << said.err;
  }
  /// Localizes by a log; the track is read and every number of it must be finite.
  Outcome localize(const std::string& log, std::vector<std::string> words = {}) {
    write_text(folder_.path() / "log.jsonl", log);
    std::filesystem::remove(track_);
    words.insert(words.begin(), {"localize", map_, folder_ / "log.jsonl", "-o", track_});
    const Outcome said = waymark(words);
    if (said.code == 0)
      expect_finite();
    else
      EXPECT_FALSE(std::filesystem::exists(track_)) << "half-written";
    return said;
  }
  void expect_finite() {
    std::istringstream rows(text_of(track_));
    std::string row;
    std::getline(rows, row);
    EXPECT_THAT(row,
                testing::StartsWith("t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected"));
    for (rows_ = 0; std::getline(rows, row); ++rows_) {
      ASSERT_THAT(row, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf")))) << row;
      std::istringstream cells(row);
      for (std::string cell; std::getline(cells, cell, ',');)
        ASSERT_TRUE(std::isfinite(std::stod(cell))) << row;
    }
  }
  nlohmann::json score(const std::string& truth, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"evaluate", "track", track_, "--truth", truth, "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0) << said.err;
    return nlohmann::json::parse(said.out);
  }
  nlohmann::json score() { return score(folder_ / "log.jsonl"); }
  /// The message of a log or option that is refused.
  std::string refusal(const std::string& log, int code = 1, const std::vector<std::string>& words = {}) {
    const Outcome said = localize(log, words);
    EXPECT_EQ(said.code, code) << said.err;
    EXPECT_THAT(said.err, testing::StartsWith("error: "));
    return said.err;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg", track_ = folder_ / "track.csv";
  int rows_ = 0;
};

TEST_F(Localize, EveryMethodFollowsAWaymarkLog) {
  for (const bool named : {true, false}) {
    const std::string log = drive_log({.named = named});
    for (const std::string method : {"ekf", "ukf", "pf", "global"}) {
      const Outcome said = localize(log, {"--method", method, "--ids", named ? "known" : "unknown"});
      ASSERT_EQ(said.code, 0) << method << said.err;
      EXPECT_EQ(rows_, 240) << method;  // one per reading
      const auto s = score();
      EXPECT_LT(s["ate_rmse"], method == "global" ? 0.5 : 0.12) << method << " named " << named;
      EXPECT_LT(s["ate_median"], 0.12) << method << " named " << named;
      EXPECT_LT(s["heading_rmse_deg"], 5) << method << " named " << named;
    }
  }
  ASSERT_EQ(localize(drive_log({}), {"--method", "odometry"}).code, 0);
  EXPECT_GT(score()["ate_rmse"], 0.12);
}

TEST_F(Localize, EveryMethodFollowsAnMrclamDataset) {
  const std::string data = folder_ / "MRCLAM", map = folder_ / "beacons.gpkg";
  write_mrclam(data);
  ASSERT_EQ(waymark({"import", data + "/Landmark_Groundtruth.dat", "--from", "mrclam", "-o", map}).code, 0);
  for (const std::string ids : {"known", "unknown"})
    for (const std::string method : {"ekf", "ukf", "pf", "global"}) {
      const Outcome said =
          waymark({"localize", map, data, "--robot", "1", "--method", method, "--ids", ids, "-o", track_});
      ASSERT_EQ(said.code, 0) << said.err;
      expect_finite();
      EXPECT_THAT(said.err, HasSubstr("no such landmark in the map"));  // the other robot
      EXPECT_LT(score(data, {"--robot", "1"})["ate_median"], 0.25) << method << ' ' << ids;
    }
  EXPECT_THAT(waymark({"localize", map, data, "-o", track_}).err, HasSubstr("add --robot 1"));
}

TEST_F(Localize, GlobalNeedsNoStartAndPfSearchesWithoutOne) {
  const std::string log = drive_log({.start = false});
  EXPECT_EQ(localize(log, {"--method", "global", "--ids", "unknown"}).code, 0);
  EXPECT_LT(score()["ate_median"], 0.12);
  EXPECT_EQ(localize(log, {"--method", "pf", "--start", "none", "--ids", "unknown"}).code, 0);
  EXPECT_LT(score()["ate_median"], 0.12);
  EXPECT_THAT(refusal(log, 2, {"--start", "none"}), HasSubstr("must know where the robot starts"));
  EXPECT_THAT(refusal(drive_log({.truth = false, .start = false})), HasSubstr("give --start X,Y,YAW"));
  EXPECT_EQ(localize(log, {"--start", "0,-6,0"}).code, 0);
  EXPECT_THAT(refusal(log, 2, {"--start", "0,-6"}), HasSubstr("--start takes X,Y,YAW"));
}

TEST_F(Localize, SettingsOutsideTheirRangeOrWithWrongNamesAreRefused) {
  const std::string log = drive_log({.steps = 4});
  EXPECT_THAT(refusal(log, 2, {"--set", "gat=0.9"}), HasSubstr("did you mean 'gate'?"));
  EXPECT_THAT(refusal(log, 2, {"--set", "gate=2"}), HasSubstr("must be within"));
  EXPECT_THAT(refusal(log, 2, {"--set", "gate=nan"}), HasSubstr("gate"));
  EXPECT_THAT(refusal(log, 2, {"--method", "kalman"}), HasSubstr("--method must be one of"));
  EXPECT_THAT(refusal(log, 2, {"--sensor", "sonarr"}), HasSubstr("sonarr"));
}

TEST_F(Localize, GnssAndCompassHelpWhereNothingIsSeen) {
  const auto blind = [](bool fixes) {
    return drive_log({.change = [fixes](int step, const std::string& kind, const std::string& line) {
      if (kind == "sightings") return std::string();
      if (kind != "truth" || !fixes) return line;
      const auto truth = nlohmann::json::parse(line);
      const double off = step % 2 ? 0.2 : -0.2;
      const nlohmann::json gnss{{"kind", "gnss"},
                                {"t", truth["t"]},
                                {"x", truth["x"].get<double>() + off},
                                {"y", truth["y"].get<double>() - off},
                                {"sd", 0.3}};
      const nlohmann::json wild{{"kind", "gnss"}, {"t", truth["t"]}, {"x", 900}, {"y", 0}, {"sd", 0.3}};
      const nlohmann::json compass{
          {"kind", "compass"}, {"t", truth["t"]}, {"yaw", truth["yaw"]}, {"sd", 0.05}};
      return line + "\n" + (step % 20 == 7 ? wild : gnss).dump() + "\n" + compass.dump();
    }});
  };
  for (const std::string method : {"ekf", "ukf", "pf"}) {
    ASSERT_EQ(localize(blind(false), {"--method", method, "--start", "truth"}).code, 0);
    const double without = score()["ate_rmse"];
    const Outcome said = localize(blind(true), {"--method", method, "--start", "truth"});
    ASSERT_EQ(said.code, 0);
    EXPECT_THAT(said.err, HasSubstr("GNSS and compass readings: 240, of which 6 were not used"));
    EXPECT_LT(score()["ate_rmse"], 0.25) << method;
    EXPECT_LT(score()["ate_rmse"], 0.7 * without) << method;
    EXPECT_EQ(localize(blind(true), {"--method", method, "--set", "use_fixes=false"}).code, 0);
    EXPECT_NEAR(score()["ate_rmse"], without, 1e-6) << method;
  }
}

TEST_F(Localize, TheDemGivesHeightRollAndPitch) {
  MadeDem dem;
  dem.columns = dem.rows = 121;
  dem.height = [](int column, int) { return 100 + 0.1 * (column - 60); };  // rises to the east
  dem.crs = "";
  dem.geotransform = {-60.5, 1, 0, 60.5, 0, -1};
  const std::string file = make_dem(folder_ / "dem.tif", dem);
  ASSERT_EQ(localize(drive_log({.named = true}), {"--dem", file}).code, 0);
  std::istringstream rows(text_of(track_));
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    EXPECT_NEAR(v[3], 100 + 0.1 * v[1], 0.01);
    EXPECT_NEAR(v[5], std::atan(-0.1 * std::cos(v[6])), 1e-3);
    EXPECT_NEAR(v[4], std::atan(-0.1 * std::sin(v[6])), 1e-3);
  }
}

class LocalizeBadInput : public Localize {
 protected:
  /// The map without its triggers, which need functions that sqlite3 alone does not have.
  void unguarded() {
    bash("sqlite3 " + map_ +
         " \"SELECT 'DROP TRIGGER ' || quote(name) || ';' FROM sqlite_master WHERE type = 'trigger'\" | "
         "sqlite3 " +
         map_);
  }
};

TEST_F(LocalizeBadInput, MapWithoutLandmarks) {
  unguarded();
  bash("sqlite3 " + map_ + " 'DELETE FROM rock'");
  EXPECT_THAT(refusal(drive_log({.steps = 4})),
              AllOf(HasSubstr("the map has no landmarks"), HasSubstr("--method odometry")));
  EXPECT_EQ(localize(drive_log({.steps = 4}), {"--method", "odometry"}).code, 0);
}

TEST_F(LocalizeBadInput, MapOfAnotherBodyOrCrs) {
  import_rocks(rocks_csv(30, 60), "IAU_2015:30100");
  EXPECT_THAT(refusal(drive_log({.steps = 4, .header = R"(,"frame":"crs","crs":"IAU_2015:49900")"})),
              AllOf(HasSubstr("the log is of Mars, the map of Moon"), HasSubstr("same body")));
  import_rocks(rocks_csv(500000, 5e6), "EPSG:32632");
  EXPECT_THAT(refusal(drive_log({.steps = 4, .header = R"(,"frame":"crs","crs":"EPSG:32633")"})),
              AllOf(HasSubstr("EPSG:32633"), HasSubstr("EPSG:32632")));
  EXPECT_EQ(refusal(drive_log({.steps = 4, .header = R"(,"crs":"nonsense")"})).empty(), false);
}

TEST_F(LocalizeBadInput, LogFarOutsideTheMap) {
  import_rocks(rocks_csv(50000, 0), "local");
  EXPECT_THAT(refusal(drive_log({.steps = 4})),
              AllOf(HasSubstr("the robot starts 50.0 km from"), HasSubstr("right map")));
  // A search cannot know that: it says that it is lost.
  import_rocks("uid,x,y,radius\na,0,0,0.3\nb,5,3,0.2\nc,9,-4,0.8\nd,2,8,0.5\n", "local");
  const Outcome said = localize(drive_log({.steps = 40}), {"--method", "global"});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("lost in"));
}

TEST_F(LocalizeBadInput, NumbersThatAreNone) {
  const auto with = [](const std::string& from, const std::string& to) {
    return drive_log({.steps = 6, .change = [=](int step, const std::string& kind, const std::string& line) {
                        if (step != 3 || kind != "sightings") return line;
                        std::string changed = line;
                        changed.replace(changed.find(from), from.size(), to);
                        return changed;
                      }});
  };
  EXPECT_THAT(refusal(with(R"("range":)", R"("range":NaN,"was":)")),
              AllOf(HasSubstr("no JSON object"), HasSubstr("line 13"), HasSubstr("null")));
  EXPECT_THAT(refusal(with(R"("range":)", R"("range":"far","was":)")),
              HasSubstr("\"range\" must be a number"));
  EXPECT_THAT(refusal(with(R"("radius":)", R"("radius":-)")), HasSubstr("\"radius\" must be above 0"));
  EXPECT_THAT(refusal(with(R"("range_sd":)", R"("range_sd":-)")), HasSubstr("\"range_sd\" must be above 0"));
  EXPECT_THAT(refusal(with(R"("range_sd":0.05)", R"("range_sd":0)")),
              HasSubstr("\"range_sd\" must be above 0"));
  // Ranges below 0 are left out, and counted.
  const Outcome said = localize(with(R"("range":)", R"("range":-)"));
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("1 not a usable number"));
  EXPECT_THAT(refusal(with(R"("range":)", R"("range":1e999,"was":)")), HasSubstr("line 13"));
}

TEST_F(LocalizeBadInput, AnglesInDegrees) {
  const auto degrees = [](const std::string& which, const std::string& key, double value) {
    return drive_log({.steps = 6, .change = [=](int step, const std::string& kind, const std::string& line) {
                        if (step != 2 || kind != which) return line;
                        auto json = nlohmann::json::parse(line);
                        (which == "sightings" ? json["items"][0] : json)[key] = value;
                        return json.dump();
                      }});
  };
  EXPECT_THAT(refusal(degrees("sightings", "bearing", -38.5)),
              AllOf(HasSubstr("-38.5"), HasSubstr("radians")));
  EXPECT_THAT(refusal(degrees("odometry", "omega", 20)),
              AllOf(HasSubstr("20"), HasSubstr("radians per second")));
  EXPECT_THAT(refusal(degrees("truth", "yaw", 170)), HasSubstr("radians"));
  EXPECT_THAT(refusal(degrees("sightings", "elevation", 4.5)), HasSubstr("radians"));
  EXPECT_THAT(refusal(drive_log({.steps = 6}), 2, {"--start", "0,0,90"}), HasSubstr("radians"));
}

TEST_F(LocalizeBadInput, TimesBackwardsTwiceAndMissing) {
  const Outcome backwards =
      localize(drive_log({.named = true, .change = [](int step, const std::string&, const std::string& line) {
                            if (step != 50) return line;
                            auto json = nlohmann::json::parse(line);
                            json["t"] = 101.25;
                            return json.dump();
                          }}));
  EXPECT_EQ(backwards.code, 0);
  EXPECT_THAT(backwards.err, HasSubstr("times run backwards; the log is sorted by time"));
  const Outcome twice =
      localize(drive_log({.named = true, .change = [](int, const std::string& kind, const std::string& line) {
                            return kind == "odometry" ? line + "\n" + line : line;
                          }}));
  EXPECT_EQ(twice.code, 0);
  EXPECT_THAT(twice.err, HasSubstr("120 odometry readings have the time of the one before"));
  EXPECT_LT(score()["ate_rmse"], 0.15);
  const Outcome gap =
      localize(drive_log({.named = true, .change = [](int step, const std::string&, const std::string& line) {
                            return step > 40 && step < 60 ? std::string() : line;
                          }}));
  EXPECT_EQ(gap.code, 0);
  EXPECT_THAT(gap.err, HasSubstr("1 gaps of more than 1 s in the odometry, the longest 10.0 s"));
  EXPECT_THAT(refusal(R"({"kind":"odometry","t":"noon","v":1,"omega":0})"),
              HasSubstr("\"t\" must be a number"));
}

TEST_F(LocalizeBadInput, SensorsAndTypesNobodyKnows) {
  const Outcome said =
      localize(drive_log({.change = [](int step, const std::string& kind, const std::string& line) {
        if (kind == "truth")
          return line + R"(
{"kind":"sonar","t":103,"echo":[1,2]})";
        if (kind == "sightings" && step % 2) {
          auto json = nlohmann::json::parse(line);
          for (auto& item : json["items"]) {
            item["type"] = "cactus";
            item.erase("features");
          }
          return json.dump();
        }
        return line;
      }}));
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("120 records of the kind 'sonar' are left out"),
                              HasSubstr("sightings of type 'cactus', which the map does not have")));
  EXPECT_LT(score()["ate_rmse"], 0.15);
}

TEST_F(LocalizeBadInput, CovariancesThatAreNone) {
  unguarded();
  bash("sqlite3 " + map_ +
       " 'UPDATE rock SET var_x = -1 WHERE id % 3 = 0; UPDATE rock SET cov_xy = 5 WHERE id % 3 = 1'");
  for (const std::string method : {"ekf", "ukf", "pf"}) {
    const Outcome said = localize(drive_log({.named = true}), {"--method", method});
    ASSERT_EQ(said.code, 0) << said.err;
    EXPECT_THAT(said.err, HasSubstr("covariance that is not positive definite"));
    EXPECT_LT(score()["ate_rmse"], 0.2) << method;
  }
}

TEST_F(LocalizeBadInput, AllRejectedForMinutesThenLandmarksReturn) {
  // For two minutes all that is seen is wrong by half a turn; odometry drifts meanwhile.
  for (const bool named : {true, false})
    for (const std::string method : {"ekf", "ukf", "pf"}) {
      const Outcome said =
          localize(drive_log({.steps = 480,
                              .named = named,
                              .change =
                                  [](int step, const std::string& kind, const std::string& line) {
                                    if (kind != "sightings" || step < 60 || step > 300) return line;
                                    auto json = nlohmann::json::parse(line);
                                    for (auto& item : json["items"])
                                      item["range"] = 40 + item["range"].get<double>();
                                    return json.dump();
                                  }}),
                   {"--method", method, "--ids", named ? "known" : "unknown"});
      ASSERT_EQ(said.code, 0) << said.err;
      EXPECT_THAT(said.err, HasSubstr("lost in")) << method << named;
      std::istringstream rows(text_of(track_));
      std::string row, last;
      while (std::getline(rows, row)) last = row;
      EXPECT_THAT(last, testing::EndsWith(",0"))
          << method << " named " << named << " is still lost: " << last;
      EXPECT_LT(score()["ate_median"], 8.0) << method << named;
    }
}

TEST_F(LocalizeBadInput, FilesThatAreNoLogsOrMaps) {
  EXPECT_THAT(refusal(""), HasSubstr("the log is empty"));
  EXPECT_THAT(refusal("t,v,omega\n1,2,3\n"), HasSubstr("no JSON object"));
  EXPECT_THAT(refusal(R"({"kind":"header","version":9})"), HasSubstr("version 9"));
  EXPECT_THAT(refusal(R"({"kind":"header","version":1})"), HasSubstr("the log has no readings"));
  EXPECT_THAT(waymark({"localize", map_, folder_ / "none.jsonl", "-o", track_}).err,
              HasSubstr("there is no such log"));
  EXPECT_THAT(waymark({"localize", map_, folder_.path(), "-o", track_}).err,
              HasSubstr("no log of a known format"));
  EXPECT_EQ(waymark({"localize", folder_ / "no.gpkg", folder_ / "log.jsonl", "-o", track_}).code, 1);
  EXPECT_EQ(waymark({"localize", map_, folder_ / "log.jsonl", "-o", folder_ / "track.txt"}).code, 2);
}

}  // namespace
}  // namespace waymark::test

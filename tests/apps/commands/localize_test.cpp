// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/apps/localize_fixture.hpp"
#include "tests/apps/made_dem.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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

// A camera of 25 m among rocks to 100 m: what it cannot see is no candidate.
TEST_F(Localize, BearingsAskForTheRangeOfTheirSensor) {
  const std::string camera = folder_ / "camera.json";
  std::ofstream(camera) << R"({"waymark_sensor":1,"coverage":{"range":25,"bearing_sd":1}})";
  const auto said = [&](std::vector<std::string> options) {
    options.insert(options.end(), {"--ids", "unknown"});
    const Outcome done = localize(R"({"kind":"header","version":1,"start":{"x":0,"y":0,"yaw":0}}
{"kind":"odometry","t":0,"v":1,"omega":0}
{"kind":"sightings","t":1,"items":[{"type":"rock","bearing":0.1}]}
)",
                                  options);
    EXPECT_EQ(done.code, 0) << done.err;
    return done.err;
  };
  EXPECT_THAT(said({}), HasSubstr("1 of 1 sightings have no range"));
  EXPECT_THAT(said({"--sensor", camera}), Not(HasSubstr("have no range")));
  EXPECT_THAT(said({"--set", "bearing_reach=25"}), Not(HasSubstr("have no range")));
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

TEST_F(Localize, TheLogStatesItsOdometryNoiseAndSettingsReplaceIt) {
  const auto track = [&](const std::string& header, const std::vector<std::string>& settings) {
    std::vector<std::string> options{"--method", "odometry", "--start", "0,0,0"};
    for (const std::string& s : settings) options.insert(options.end(), {"--set", s});
    const Outcome said = localize(header + "\n" + R"({"kind":"odometry","t":0,"v":1,"omega":0.1}
{"kind":"odometry","t":1,"v":1,"omega":-0.1}
{"kind":"odometry","t":2,"v":0,"omega":0}
)",
                                  options);
    EXPECT_EQ(said.code, 0) << said.err;
    return text_of(track_);
  };
  const std::string none = R"({"kind":"header","version":1})";
  const std::string noisy =
      R"({"kind":"header","version":1,"odometry_noise":{"yaw_per_metre":0.3,"scale_sd":0.1}})";
  const std::string stated = track(noisy, {});
  EXPECT_NE(stated, track(none, {}));
  EXPECT_EQ(stated, track(none, {"yaw_per_metre=0.3", "scale_sd=0.1"}));
  EXPECT_EQ(track(noisy, {"yaw_per_metre=0.002", "scale_sd=0"}), track(none, {}));
  EXPECT_EQ(track(noisy, {"yaw_per_metre=0.002"}), track(none, {"scale_sd=0.1"}));
}

TEST_F(Localize, SettingsNeedNeitherMapNorLog) {
  const Outcome said = waymark({"localize", "--settings", "--method", "pf", "--set", "particles=777"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("particles=777  "));
  std::set<std::string> names;
  std::istringstream lines(said.out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(names.insert(line.substr(0, line.find('='))).second) << "twice: " << line;
  EXPECT_GT(names.size(), 20u);
  EXPECT_THAT(waymark({"localize", "--method", "pf"}).err, HasSubstr("needs MAP.gpkg"));
}

TEST_F(Localize, SettingsThatTheMethodDoesNotReadAreSaid) {
  const std::string log = drive_log({});
  const auto said = [&](const std::string& method, const std::string& setting) {
    const Outcome done = localize(log, {"--method", method, "--set", setting});
    EXPECT_EQ(done.code, 0) << done.err;
    return done.err;
  };
  ASSERT_EQ(localize(log, {"--method", "ekf"}).code, 0);
  const std::string without = text_of(track_);
  EXPECT_THAT(said("ekf", "particles=50"),
              HasSubstr("--set particles=50 has no effect: --method ekf does not read it, but global, pf"));
  EXPECT_EQ(text_of(track_), without);
  EXPECT_THAT(said("ekf", "slam_match=4"), HasSubstr("does not read it, but graph, slam"));
  EXPECT_THAT(said("pf", "hypotheses=9"), HasSubstr("does not read it, but ekf, ukf"));
  EXPECT_THAT(said("pf", "least_weight=1e-5"),
              HasSubstr("does not read it, but ekf, ukf"));  // its former name
  EXPECT_THAT(said("odometry", "gate=0.9"), HasSubstr("has no effect"));
  for (const auto& [method, setting] : {std::pair("ekf", "detection=0.5"),
                                        {"pf", "particles=50"},
                                        {"slam", "slam_match=4"},
                                        {"odometry", "along_per_metre=0.1"},
                                        {"beacons", "range_offset_sd=1"}})
    EXPECT_THAT(said(method, setting), Not(HasSubstr("has no effect")));
  EXPECT_THAT(localize(log, {"--method", "ekf", "--set", "particles=1"}).err, HasSubstr("is outside [10"));
  EXPECT_THAT(localize(log, {"--method", "ekf", "--settings"}).out, Not(HasSubstr("particles=")));
}

TEST_F(Localize, WrongMatchesAreNotKnownWithoutIdentities) {
  ASSERT_EQ(localize(drive_log({.named = false}), {"--method", "ekf", "--ids", "unknown"}).code, 0);
  EXPECT_GT(score()["matches"], 0);
  EXPECT_TRUE(score()["wrong_matches"].is_null());
  ASSERT_EQ(localize(drive_log({.named = true}), {"--method", "ekf", "--ids", "unknown"}).code, 0);
  EXPECT_EQ(score()["wrong_matches"], 0);
}

TEST_F(Localize, ImprobableLandmarksCanBeLeftOut) {
  const Outcome none = localize(drive_log({}), {"--method", "ekf", "--min-confidence", "1"});
  EXPECT_EQ(none.code, 0) << none.err;  // imported rocks have confidence 1
  ASSERT_EQ(bash("ogrinfo -q " + map_ + " -sql 'UPDATE rock SET confidence = 0.4'").code, 0);
  const Outcome said = localize(drive_log({}), {"--method", "ekf", "--min-confidence", "0.5"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err,
              AllOf(HasSubstr("no landmark of confidence 0.5 or more"), HasSubstr("lower --min-confidence")));
  EXPECT_EQ(localize(drive_log({}), {"--method", "ekf", "--min-confidence", "0.3"}).code, 0);
}

TEST_F(Localize, ATruthTooCoarseToInterpolateIsNamed) {
  write_text(track_, "t,x,y,yaw\n0.5,1,0,0\n1.5,2,0,0\n");
  write_text(folder_.path() / "truth.csv", "t,x,y,yaw\n0,0,0,0\n1,1,0,0\n2,0,0,0\n");
  const std::vector<std::string> words{"evaluate", "track", track_, "--truth", folder_ / "truth.csv"};
  EXPECT_THAT(waymark(words).err,
              AllOf(HasSubstr("the true poses are up to 1 s apart"), HasSubstr("--max-gap 1.01")));
  write_text(track_, "t,x,y,yaw\n70.5,1,0,0\n");
  EXPECT_THAT(waymark(words).err, HasSubstr("no time in common: 70.500 to 70.500 s and 0.000 to 2.000 s"));
}

TEST_F(Localize, ASightingNeedsABearingOrARange) {
  std::string log = drive_log({});
  for (const std::string name : {"\"bearing\"", "\"range\""})
    for (std::size_t at; (at = log.find(name)) != std::string::npos;)
      log.replace(at, name.size(), "\"other\"");
  const Outcome said = localize(log, {"--method", "ekf"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("a sighting with neither \"bearing\" nor \"range\""));
}

TEST_F(Localize, RangesAlonePlaceTheRobot) {
  const auto ranges = [](bool named) {
    std::string log;
    std::istringstream lines(drive_log({.named = named, .features = false}));
    for (std::string line; std::getline(lines, line);) {
      nlohmann::json record = nlohmann::json::parse(line);
      if (record["kind"] == "sightings")
        for (nlohmann::json& item : record["items"]) item.erase("bearing"), item.erase("bearing_sd");
      log += record.dump() + '\n';
    }
    return log;
  };
  for (const std::string method : {"ekf", "ukf", "pf", "slam", "graph"}) {
    const Outcome said = localize(ranges(false), {"--method", method, "--start", "truth"});
    ASSERT_EQ(said.code, 0) << method << said.err;
    EXPECT_LT(score()["ate_rmse"].get<double>(), 0.3) << method;
  }
  for (const std::string method : {"pf", "ekf"}) {
    ASSERT_EQ(localize(ranges(true), {"--method", method, "--start", "none"}).code, 0) << method;
    const auto last = last_row();
    EXPECT_EQ(last.at("lost"), 0) << method;
  }
}

TEST_F(Localize, TracksKeepHowPlaceAndHeadingErrTogether) {
  ASSERT_EQ(localize(drive_log({}), {"--method", "ekf"}).code, 0);
  EXPECT_THAT(text_of(track_), HasSubstr(",lost,cov_x_yaw,cov_y_yaw,nis,nis_rows\n"));
  write_text(track_,
             "t,x,y,yaw,var_x,var_y,var_yaw,cov_x_yaw\n0,1,0,1,1,1,1,0.9\n1,2,0,1,1,1,1,0.9\n"
             "2,1,0,1,1,1,1,0.9\n");
  write_text(folder_.path() / "truth.csv", "t,x,y,yaw\n0,0,0,0\n1,1,0,0\n2,0,0,0\n");
  // e' P^-1 e = (1 - 2 * 0.9 + 1) / (1 - 0.9^2), over 3.
  const nlohmann::json said = score(folder_ / "truth.csv");
  EXPECT_NEAR(said["anees"], 0.2 / 0.19 / 3, 1e-9);
  EXPECT_EQ(said["anees_independent"], 1);
  EXPECT_LT(said["anees_band"][0], said["anees"]);
  EXPECT_GT(said["anees_band"][1], 3);
}

TEST_F(Localize, EvaluateTellsInnovationsAndTimes) {
  const std::string log = drive_log({});
  ASSERT_EQ(localize(log, {"--method", "ekf", "--timing"}).code, 0);
  EXPECT_THAT(text_of(track_), HasSubstr(",nis_rows,seconds_used\n"));
  const nlohmann::json said = score();
  EXPECT_GT(said["anis"], 0.1);
  EXPECT_LT(said["anis"], 3);
  EXPECT_LT(said["anis_band"][0], said["anis_band"][1]);
  EXPECT_GT(said["time_per_update_us"], 0);
  for (const std::string method : {"odometry", "pf"}) {  // particles are identified after the update
    ASSERT_EQ(localize(log, {"--method", method}).code, 0);
    EXPECT_TRUE(score()["anis"].is_null()) << method;
  }
  EXPECT_TRUE(score()["time_per_update_us"].is_null());
}

TEST_F(Localize, GlobalNeedsNoStartAndPfSearchesWithoutOne) {
  const std::string log = drive_log({.start = false});
  EXPECT_EQ(localize(log, {"--method", "global", "--ids", "unknown"}).code, 0);
  EXPECT_LT(score()["ate_median"], 0.12);
  EXPECT_EQ(localize(log, {"--method", "pf", "--start", "none", "--ids", "unknown"}).code, 0);
  EXPECT_LT(score()["ate_median"], 0.12);
  for (const char* method : {"ekf", "ukf"}) {
    EXPECT_EQ(localize(log, {"--method", method, "--start", "none", "--ids", "unknown"}).code, 0) << method;
    EXPECT_LT(score()["ate_median"], 0.12) << method;
  }
  EXPECT_THAT(refusal(log, 2, {"--method", "odometry", "--start", "none"}),
              HasSubstr("must know where the robot starts"));
  EXPECT_THAT(refusal(drive_log({.truth = false, .start = false})), HasSubstr("give --start X,Y,YAW"));
  EXPECT_EQ(localize(log, {"--start", "0,-6,0"}).code, 0);
  EXPECT_THAT(refusal(log, 2, {"--start", "0,-6"}), HasSubstr("--start takes X,Y,YAW"));
}

TEST_F(Localize, AStartMayBeThePoseAtALaterTime) {
  // The robot turns left for a second, then drives 2 m in two seconds.
  const std::string log = R"({"kind":"header","version":1}
{"kind":"odometry","t":10,"v":0,"omega":1.5707963268}
{"kind":"odometry","t":11,"v":1,"omega":0}
{"kind":"odometry","t":12,"v":1,"omega":0}
{"kind":"odometry","t":13,"v":0,"omega":0}
)";
  const auto rows = [&](const std::string& text, const std::string& start) {
    EXPECT_EQ(localize(text, {"--method", "odometry", "--start", start}).code, 0);
    std::vector<std::array<double, 4>> all;  // x, y, yaw, var_x
    std::istringstream lines(text_of(track_));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);) {
      std::array<double, 8> cell{};
      std::istringstream cells(line);
      for (double& c : cell) cells >> c, cells.ignore();
      all.push_back({cell[1], cell[2], cell[6], cell[7]});
    }
    return all;
  };
  const auto track = rows(log, "5,3,1.5707963268,13");
  ASSERT_EQ(track.size(), 4);
  EXPECT_NEAR(track[0][0], 5, 1e-4);
  EXPECT_NEAR(track[0][1], 1, 1e-4);
  EXPECT_NEAR(track[0][2], 0, 1e-4);
  EXPECT_NEAR(track[3][1], 3, 1e-4);
  EXPECT_GT(track[0][3], rows(log, "5,1,0")[0][3]);  // odometry errs on the way back, too
  // Truth that begins more than 5 s after the log is such a start.
  const std::string late = R"({"kind":"header","version":1}
{"kind":"odometry","t":0,"v":1,"omega":0}
{"kind":"odometry","t":1,"v":0,"omega":0}
{"kind":"odometry","t":8,"v":0,"omega":0}
{"kind":"truth","t":8,"x":4,"y":2,"yaw":0}
)";
  EXPECT_NEAR(rows(late, "truth")[0][0], 3, 1e-4);
  EXPECT_THAT(refusal(log, 2, {"--method", "odometry", "--start", "5,3,1.57,14"}),
              HasSubstr("the time of --start is 14.000 s, the log is from 10.000 to 13.000 s"));
}

TEST_F(Localize, SettingsOutsideTheirRangeOrWithWrongNamesAreRefused) {
  const std::string log = drive_log({.steps = 4});
  EXPECT_THAT(refusal(log, 2, {"--set", "gat=0.9"}), HasSubstr("did you mean 'gate'?"));
  EXPECT_THAT(refusal(log, 2, {"--set", "gate=2"}), HasSubstr("gate = 2 is outside ["));
  EXPECT_THAT(refusal(log, 2, {"--set", "gate=nan"}), HasSubstr("gate"));
  EXPECT_THAT(refusal(log, 2, {"--method", "kalman"}), HasSubstr("--method must be one of"));
  EXPECT_THAT(refusal(log, 2, {"--sensor", "sonarr"}), HasSubstr("sonarr"));
}

TEST_F(Localize, FormerNamesOfSettingsAreReadWithAWarning) {
  const std::string log = drive_log({.steps = 4});
  const Outcome renamed = localize(log, {"--set", "longest_hold=2"});
  EXPECT_EQ(renamed.code, 0);
  EXPECT_THAT(renamed.err, HasSubstr("longest_hold was renamed: use max_hold (--set longest_hold=2)"));
  EXPECT_THAT(localize(log, {"--settings", "--set", "max_hold=2"}).out, HasSubstr("max_hold=2  "));
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
  for (const std::string method : {"ekf", "ukf", "pf", "slam"}) {
    ASSERT_EQ(localize(blind(false), {"--method", method, "--start", "truth"}).code, 0);
    const double without = score()["ate_rmse"];
    const Outcome said = localize(blind(true), {"--method", method, "--start", "truth"});
    ASSERT_EQ(said.code, 0);
    EXPECT_THAT(said.err, HasSubstr("GNSS and compass readings: 240, 6 of them not used"));
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

TEST_F(Localize, TheTrackIsTheSameForAnyNumberOfThreads) {
  const std::string log = drive_log({.steps = 60});
  for (const std::vector<std::string>& how : {std::vector<std::string>{"--method", "pf", "--start", "none"},
                                              {"--method", "global"},
                                              {"--method", "pf", "--set", "particles=5000"},
                                              {"--method", "ekf"}}) {
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
      std::vector<std::string> words = how;
      words.insert(words.end(), {"--ids", "unknown", "--threads", threads});
      ASSERT_EQ(localize(log, words).code, 0) << how[1];
      if (first.empty()) first = text_of(track_);
      EXPECT_TRUE(text_of(track_) == first) << how[1] << " on " << threads;
    }
  }
}

TEST_F(Localize, TheDemSaysWhatCouldNotBeSeen) {
  MadeDem dem;
  dem.columns = dem.rows = 121;
  dem.height = [](int column, int) { return column == 64 ? 4.0 : 0.0; };  // a wall at x = 4
  dem.crs = "";
  dem.geotransform = {-60.5, 1, 0, 60.5, 0, -1};
  const std::string file = make_dem(folder_ / "dem.tif", dem);
  // Nothing beyond the wall is seen, until the robot comes near it.
  const auto behind = [&](int step, const std::string& kind, const std::string& line) {
    if (kind != "sightings") return line;
    auto event = nlohmann::json::parse(line);
    nlohmann::json kept = nlohmann::json::array();
    for (const auto& item : event["items"])
      if (item["range"].get<double>() < 6) kept.push_back(item);
    event["items"] = kept;
    (void)step;
    return event.dump();
  };
  const std::string log = drive_log({.steps = 60, .change = behind});
  for (const std::string method : {"ekf", "ukf", "pf"}) {
    const std::vector<std::string> expects{"--method",           method,  "--ids",       "unknown", "--set",
                                           "expect_unseen=true", "--set", "view_range=9"};
    ASSERT_EQ(localize(log, expects).code, 0) << method;
    const std::string without = text_of(track_);
    std::vector<std::string> words = expects;
    words.insert(words.end(), {"--dem", file});
    ASSERT_EQ(localize(log, words).code, 0) << method;
    EXPECT_LT(score()["ate_rmse"], 0.25) << method;
    if (method == "pf") {
      EXPECT_NE(text_of(track_), without) << "the DEM was not asked";
    }
  }
}

TEST_F(Localize, ATrueYawMayGoOnTurning) {
  double yaw = 0, last = 0;
  const std::string log =
      drive_log({.steps = 400, .change = [&](int, const std::string& kind, const std::string& line) {
                   if (kind != "truth") return line;
                   auto event = nlohmann::json::parse(line);
                   const double now = event["yaw"];
                   yaw += std::remainder(now - last, 2 * M_PI);
                   last = now;
                   event["yaw"] = yaw;
                   return event.dump();
                 }});
  ASSERT_GT(yaw, 13) << "more than two turns";
  ASSERT_EQ(localize(log, {"--ids", "unknown"}).code, 0);
  EXPECT_LT(score()["heading_rmse_deg"], 3);
}

// A sensor 0.2 m ahead and 0.3 m right of the place that the log states.
TEST_F(Localize, ThePlaceOfTheSensorsIsEstimatedAndPrinted) {
  MadeDrive drive;
  drive.named = true;
  drive.header =
      R"(,"odometry_noise":{"along_per_metre":0.001,"across_per_metre":1e-5,"yaw_per_metre":1e-4,"yaw_per_radian":0.001})";
  drive.change = [](int, const std::string& kind, const std::string& line) {
    if (kind != "sightings") return line;
    json record = json::parse(line);
    for (json& item : record["items"]) {
      const double range = item["range"], bearing = item["bearing"];
      const double x = range * std::cos(bearing) - 0.2, y = range * std::sin(bearing) + 0.3;
      item["range"] = std::hypot(x, y), item["bearing"] = std::atan2(y, x);
    }
    return record.dump();
  };
  const Outcome taken = localize(drive_log(drive), {"--format", "json"});
  ASSERT_EQ(taken.code, 0) << taken.err;
  EXPECT_TRUE(json::parse(taken.out)["sensor_place"].is_null());
  const double without = score()["ate_rmse"];
  EXPECT_GT(without, 0.25);
  const Outcome said = localize(drive_log(drive), {"--format", "json", "--set", "mount_sd=0.5"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json place = json::parse(said.out)["sensor_place"];
  const double forward = place["forward_m"], left = place["left_m"];
  const double forward_sd = place["forward_sd_m"], left_sd = place["left_sd_m"];
  EXPECT_LT(forward_sd, 0.1);
  EXPECT_LT(left_sd, 0.1);
  EXPECT_LT(std::abs(forward - 0.2), 3 * forward_sd);
  EXPECT_LT(std::abs(left + 0.3), 3 * left_sd);
  EXPECT_LT(double(score()["ate_rmse"]), without / 2);
  EXPECT_THAT(localize(drive_log(drive), {"--set", "mount_sd=0.5"}).err,
              HasSubstr("sensors, beside their place in the log: 0."));
}

}  // namespace
}  // namespace waymark::test

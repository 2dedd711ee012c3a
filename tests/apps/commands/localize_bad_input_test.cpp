// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/localize_fixture.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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
                        auto event = nlohmann::json::parse(line);
                        (which == "sightings" ? event["items"][0] : event)[key] = value;
                        return event.dump();
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
                            auto event = nlohmann::json::parse(line);
                            event["t"] = 101.25;
                            return event.dump();
                          }}));
  EXPECT_EQ(backwards.code, 0);
  EXPECT_THAT(backwards.err, HasSubstr("times run backwards; the log was sorted by time"));
  const Outcome twice =
      localize(drive_log({.named = true, .change = [](int, const std::string& kind, const std::string& line) {
                            return kind == "odometry" ? line + "\n" + line : line;
                          }}));
  EXPECT_EQ(twice.code, 0);
  EXPECT_THAT(twice.err, HasSubstr("120 odometry readings repeat the time of the previous one"));
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
          auto event = nlohmann::json::parse(line);
          for (auto& item : event["items"]) {
            item["type"] = "cactus";
            item.erase("features");
          }
          return event.dump();
        }
        return line;
      }}));
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, AllOf(HasSubstr("120 records of the kind 'sonar' are skipped"),
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
                                    auto event = nlohmann::json::parse(line);
                                    for (auto& item : event["items"])
                                      item["range"] = 40 + item["range"].get<double>();
                                    return event.dump();
                                  }}),
                   {"--method", method, "--ids", named ? "known" : "unknown"});
      ASSERT_EQ(said.code, 0) << said.err;
      EXPECT_THAT(said.err, HasSubstr("lost in")) << method << named;
      EXPECT_EQ(last_row().at("lost"), 0) << method << " named " << named << " is still lost";
      EXPECT_LT(score()["ate_median"], 8.0) << method << named;
    }
}

TEST_F(LocalizeBadInput, ARobotIsOneOfMrclam) {
  EXPECT_THAT(refusal(drive_log({}), 2, {"--robot", "3"}),
              AllOf(HasSubstr("robot 3 is asked for in a log of the format waymark"), HasSubstr("MRCLAM")));
}

// Eqs. 9-11 as a whole: each sighting alone, and nothing that decides by another distance.
TEST_F(LocalizeBadInput, DistanceOfThePaperIsTheWholeChain) {
  const std::string log = drive_log({.steps = 200});
  const auto track_with = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> words{"--method", "ekf", "--ids", "unknown"};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    EXPECT_EQ(localize(log, words).code, 0);
    return text_of(track_);
  };
  EXPECT_EQ(track_with({"distance=paper"}), track_with({"distance=paper", "association=nearest"}));
  EXPECT_THAT(refusal(log, 2, {"--method", "ekf", "--set", "distance=paper", "--set", "association=jcbb"}),
              AllOf(HasSubstr("association=jcbb decides by its own evidence"), HasSubstr("nearest")));
  EXPECT_THAT(refusal(log, 2, {"--method", "pf", "--set", "distance=paper"}),
              AllOf(HasSubstr("weights=likelihood"), HasSubstr("--set weights=paper")));
  EXPECT_THAT(refusal(log, 2, {"--method", "slam", "--set", "distance=paper"}), HasSubstr("--method slam"));
  for (const std::string method : {"odometry", "beacons"})
    EXPECT_THAT(refusal(log, 2, {"--method", method, "--set", "distance=paper"}),
                HasSubstr("--method " + method + " associates nothing by features"));
  // alpha_f changes eq. 11, and is refused where nothing uses it.
  EXPECT_NE(track_with({"distance=paper", "alpha=rock.radius=40"}), track_with({"distance=paper"}));
  EXPECT_THAT(refusal(log, 2, {"--method", "ekf", "--set", "alpha=rock.radius=4"}),
              AllOf(HasSubstr("alpha_f belongs to eq. 11"), HasSubstr("add --set distance=paper")));
  EXPECT_THAT(refusal(log, 2, {"--method", "pf", "--set", "alpha=rock.radius=4"}),
              HasSubstr("add --set weights=paper"));
  EXPECT_EQ(localize(log, {"--method", "pf", "--set", "distance=paper", "--set", "weights=paper"}).code, 0);
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

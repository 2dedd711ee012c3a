// SPDX-License-Identifier: Apache-2.0
// Sensor files through the program, and summaries over drives.
#include "tests/apps/localize_fixture.hpp"

namespace waymark::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(Localize, ASensorIsFittedToADriveAndUsedByEveryCommand) {
  MadeDrive drive;
  drive.steps = 400;
  write_text(folder_.path() / "drive.jsonl", drive_log(drive));
  const std::string mine = folder_ / "mine.json";
  const Outcome fitted = waymark({"train", "sensor", folder_ / "drive.jsonl", "--map", map_, "-o", mine});
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("Fitted to"));
  const auto coverage = nlohmann::json::parse(text_of(mine)).at("coverage");
  EXPECT_NEAR(coverage.at("range").get<double>(), drive.reach, 0.5);
  EXPECT_LT(coverage.at("range_sd").get<double>(), 0.2);

  EXPECT_THAT(waymark({"sensors", mine}).out, HasSubstr("Fitted to"));
  EXPECT_EQ(waymark({"query", map_, "--sensor", mine, "--limit", "1"}).code, 0);
  EXPECT_EQ(localize(drive_log(drive), {"--sensor", mine, "--set", "quality=paper"}).code, 0);
  const Outcome settings =
      waymark({"localize", map_, folder_ / "drive.jsonl", "-o", track_, "--sensor", mine, "--settings"});
  EXPECT_EQ(settings.code, 0) << settings.err;
  EXPECT_THAT(settings.out, testing::Not(HasSubstr("view_range=20 ")));

  // The map that SLAM writes records the profile.
  const std::string updated = folder_ / "updated.gpkg";
  const Outcome slam = waymark({"localize", map_, folder_ / "drive.jsonl", "-o", track_, "--method", "slam",
                                "--sensor", mine, "--write-map", updated});
  ASSERT_EQ(slam.code, 0) << slam.err;
  const std::string jobs = bash("sqlite3 " + updated + " 'SELECT job FROM run ORDER BY id DESC LIMIT 1'").out;
  EXPECT_EQ(nlohmann::json::parse(jobs).at("sensor").at("coverage"), coverage);

  // Later commands use the recorded profile.
  const auto rows = [&](const std::string& map, const std::string& sensor) {
    return waymark({"query", map, "--sensor", sensor, "--format", "csv"});
  };
  EXPECT_EQ(rows(updated, "map").out, rows(updated, mine).out);
  EXPECT_THAT(rows(map_, "map").err, HasSubstr("no run of the map records a sensor"));
  const auto quality = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"evaluate", "landmarks", updated, "--truth", map_, "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0) << said.err;
    return nlohmann::json::parse(said.out).dump();
  };
  const std::string heights = folder_ / "heights.json";
  write_text(heights, R"({"waymark_sensor": 1, "weights": {"rock": {"height": 1}}})");
  EXPECT_EQ(quality({"--sensor", "map"}), quality({"--sensor", mine}));
  EXPECT_NE(quality({"--sensor", heights}), quality({"--sensor", mine}));
  EXPECT_EQ(waymark({"evaluate", "track", track_, "--truth", track_, "--sensor", mine}).code, 2);
}

TEST_F(Localize, ASensorOfARunIsRecordedAndPlanned) {
  const std::string sensor = folder_ / "my sensor.json", job = folder_ / "job.json";
  write_text(sensor, R"({"waymark_sensor": 1, "weights": {"mountain_top": {"elevation": 1}}})");
  const std::string dem = std::string(WAYMARK_SOURCE_DIR) + "/sample_data/jacksboro/dem.tif";
  write_text(job, waymark({"peaks", dem, "-o", folder_ / "peaks.gpkg", "--print-job"}).out);
  const Outcome plan = waymark({"plan", job, "--work", folder_ / "work", "--format", "parallel", "-o",
                                folder_ / "peaks.gpkg", "--sensor", sensor});
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("--sensor '" + sensor + "' -o"));
  EXPECT_THAT(waymark({"plan", job, "--work", folder_ / "work", "--sensor", sensor}).err,
              HasSubstr("the plan writes none"));
  EXPECT_EQ(waymark({"plan", job, "--work", folder_ / "work", "-o", folder_ / "peaks.gpkg", "--sensor",
                     "stereo_camra"})
                .code,
            2);
  const Outcome run = waymark({"run", job, "-o", folder_ / "peaks.gpkg", "--sensor", sensor});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(waymark({"query", folder_ / "peaks.gpkg", "--sensor", "map"}).code, 0);
}

/// Replaces the standard deviations of every sighting by `text`.
std::string with_deviations(const std::string& text) {
  MadeDrive drive;
  drive.change = [&](int, const std::string&, std::string line) {
    const std::string stated = R"(,"range_sd":0.05,"bearing_sd":0.01)";
    for (std::size_t at = 0; (at = line.find(stated, at)) != std::string::npos; at += text.size())
      line.replace(at, stated.size(), text);
    return line;
  };
  return drive_log(drive);
}

TEST_F(Localize, SightingsWithoutDeviationsTakeThoseOfTheSensor) {
  const std::string mine = folder_ / "mine.json";
  write_text(mine, R"({"waymark_sensor": 1, "coverage": {"range_sd": 0.3, "bearing_sd": 2}})");
  ASSERT_EQ(localize(with_deviations(R"(,"range_sd":0.3,"bearing_sd":0.034906585039886591)")).code, 0);
  const std::string stated = text_of(track_);
  ASSERT_EQ(localize(with_deviations(""), {"--sensor", mine}).code, 0);
  EXPECT_EQ(text_of(track_), stated);
  ASSERT_EQ(localize(with_deviations("")).code, 0);
  EXPECT_NE(text_of(track_), stated) << "without a profile other deviations are assumed";
  ASSERT_EQ(localize(with_deviations(R"(,"range_sd":0.05,"bearing_sd":0.01)")).code, 0);
  const std::string sharp = text_of(track_);
  ASSERT_EQ(localize(with_deviations(R"(,"range_sd":0.05,"bearing_sd":0.01)"), {"--sensor", mine}).code, 0);
  EXPECT_EQ(text_of(track_), sharp) << "what the log states wins";
}

TEST_F(Localize, ASensorFileThatIsWrongIsRefused) {
  const std::string mine = folder_ / "mine.json";
  write_text(mine, R"({"waymark_sensor": 1, "weights": {"rock": {"radius": 0.5}}})");
  const Outcome said = waymark({"query", map_, "--sensor", mine});
  EXPECT_EQ(said.code, 2);
  EXPECT_THAT(said.err, AllOf(HasSubstr("the weights of rock sum to 0.5"), HasSubstr("mine.json")));
  const Outcome none = waymark({"query", map_, "--sensor", folder_ / "none.json"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("the sensor file"));
  const Outcome no_map = waymark({"train", "sensor", mine, "-o", folder_ / "out.json"});
  EXPECT_EQ(no_map.code, 2);
  EXPECT_THAT(no_map.err, HasSubstr("--map"));
}

TEST_F(Localize, ASensorFileIsChecked) {
  const std::string file = folder_ / "mine.json";
  write_text(file, R"({"waymark_sensor": 1, "weights": {"rocks": {"radius": 1}}})");
  const Outcome typo = waymark({"sensors", file});
  EXPECT_EQ(typo.code, 0);
  EXPECT_THAT(typo.err, HasSubstr("no landmark type of this program is named 'rocks'; 'rock' is"));
  write_text(file, R"({"weights": {}})");
  EXPECT_THAT(waymark({"sensors", file}).err, HasSubstr("`waymark sensors NAME --format json` prints one"));
}

TEST_F(Localize, DrivesAreSummarized) {
  MadeDrive drive;
  ASSERT_EQ(localize(drive_log(drive)).code, 0);
  const std::string log = folder_ / "log.jsonl", picture = folder_ / "bands.svg";
  const std::vector<std::string> words{"evaluate",         "track",     track_, "--truth", log, "--drive",
                                       track_ + "=" + log, "--picture", picture};
  const Outcome text = waymark(words);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("95 % interval"), HasSubstr("ATE RMSE, m"), HasSubstr("ANEES")));
  EXPECT_THAT(text_of(picture), AllOf(HasSubstr("<polygon"), HasSubstr("2 drives")));
  const auto one = score(log);
  const auto both = score(log, {"--drive", track_ + "=" + log});
  EXPECT_EQ(both.at("drives"), 2);
  EXPECT_EQ(both.at("summary").at("ATE RMSE, m").at("median"), one.at("ate_rmse"));
  const Outcome wrong = waymark({"evaluate", "track", track_, "--truth", log, "--drive", "track.csv"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--drive takes TRACK=TRUTH"));
}

}  // namespace
}  // namespace waymark::test

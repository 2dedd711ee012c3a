// SPDX-License-Identifier: Apache-2.0
// Sensor files through the program, and summaries over drives.
#include "localize_fixture.hpp"

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

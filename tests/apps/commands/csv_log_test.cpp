// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "tests/apps/localize_fixture.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// The lines of a log, as rows of a table with all its fields; `scale` of speeds and angles.
std::string as_csv(const std::string& log, const std::string& names, double speed = 1, double angle = 1) {
  std::ostringstream csv;
  csv.precision(17);
  csv << names << '\n';
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const json record = json::parse(line);
    const std::string kind = record["kind"];
    const auto number = [&](const json& from, const char* key, double scale = 1) {
      csv << ',';
      if (from.contains(key)) csv << from[key].get<double>() * scale;
    };
    if (kind == "odometry") {
      csv << record["t"].get<double>();
      number(record, "v", speed), number(record, "omega", angle);
      csv << ",,,,,\n";
    }
    if (kind == "truth") {
      csv << record["t"].get<double>() << ",,,,";
      for (const char* key : {"x", "y", "yaw"}) number(record, key);
      csv << '\n';
    }
    if (kind == "sightings")
      for (const json& item : record["items"]) {
        csv << record["t"].get<double>() << ",,";
        number(item, "bearing", angle), number(item, "range");
        csv << ",,,\n";
      }
  }
  return csv.str();
}

class CsvLog : public Localize {
 protected:
  Outcome run(const std::string& csv, std::vector<std::string> more = {},
              const std::string& out = "csv.csv") {
    write_text(folder_.path() / "drive.csv", csv);
    std::vector<std::string> words{"localize", map_, folder_ / "drive.csv", "-o", folder_ / out};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  std::string plain_drive() { return drive_log({.named = false, .features = false}); }
};

TEST_F(CsvLog, ATableGivesTheTrackOfItsRecords) {
  // Sightings of the records have types; those of the table have not, so the log drops them, too.
  std::string log;
  std::istringstream lines(plain_drive());
  for (std::string line; std::getline(lines, line);) {
    json record = json::parse(line);
    if (record["kind"] == "header") continue;
    if (record["kind"] == "sightings") {
      json items = json::array();
      for (const json& item : record["items"])
        items.push_back({{"bearing", item["bearing"]}, {"range", item["range"]}});
      record = {{"kind", "sightings"}, {"t", record["t"]}, {"items", items}};
    }
    log += record.dump() + '\n';
  }
  ASSERT_EQ(localize(log, {"--start", "truth"}).code, 0);
  const Outcome same =
      run(as_csv(log, "t,v,omega,bearing,range,truth_x,truth_y,truth_yaw"), {"--start", "truth"});
  ASSERT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(text_of(folder_ / "csv.csv"), text_of(track_));
  const double degree = 180 / 3.14159265358979323846;
  const Outcome mapped =
      run(as_csv(log, "Stamp,\"Speed (km/h)\",rate,b,r,e,n,h", 3.6, degree),
          {"--start", "truth", "--columns",
           "t=stamp,v=\"Speed "
           "(km/h)\"/3.6,omega=rad(rate),bearing=rad(b),range=r,truth_x=e,truth_y=n,truth_yaw=h"});
  ASSERT_EQ(mapped.code, 0) << mapped.err;
  track_ = folder_ / "csv.csv";
  const auto last = last_row();
  track_ = folder_ / "track.csv";
  EXPECT_NEAR(last.at("x"), last_row().at("x"), 1e-4);
  EXPECT_NEAR(last.at("yaw"), last_row().at("yaw"), 1e-5);
}

TEST_F(CsvLog, ATrackIsJudgedByItsTruth) {
  const std::string log = plain_drive();
  ASSERT_EQ(localize(log, {"--start", "truth", "--method", "odometry"}).code, 0);
  write_text(folder_.path() / "truth.csv", as_csv(log, "stamp,v,omega,bearing,range,e,n,h"));
  const auto score_by = [&](const std::string& truth, const std::vector<std::string>& more) {
    std::vector<std::string> words{"evaluate", "track", track_, "--truth", truth, "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome said = waymark(words);
    return said.code == 0 ? json::parse(said.out)["ate_rmse"].get<double>() : -1;
  };
  const double by_log = score_by(folder_ / "log.jsonl", {});
  EXPECT_GT(by_log, 0);
  EXPECT_NEAR(score_by(folder_ / "truth.csv",
                       {"--log-format", "csv", "--columns", "t=stamp,truth_x=e,truth_y=n,truth_yaw=h"}),
              by_log, 1e-6);
}

// Detectors of other programs write positions in the frame of the robot, each into a table with the odometry.
TEST_F(CsvLog, SightingsMayBePositions) {
  const std::string head = "t,v,omega,";
  const auto rows = [](auto sighting) {
    std::string text;
    for (int i = 0; i < 40; ++i) {
      const double t = 0.1 * i;
      text += fmt::format("{},1,0,,,,\n{},,,{}\n", t, t, sighting(8 - 0.1 * i, -3.0));
    }
    return text;
  };
  const std::vector<std::string> start{"--start", "0,0,0", "--ids", "unknown"};
  const Outcome by_position = run(head + "seen_x,seen_y,seen_sd,\n" + rows([](double x, double y) {
                                    return fmt::format("{},{},0.2,", x, y);
                                  }),
                                  start, "position.csv");
  ASSERT_EQ(by_position.code, 0) << by_position.err;
  const Outcome by_range =
      run(head + "range,bearing,range_sd,bearing_sd\n" + rows([](double x, double y) {
            const double range = std::hypot(x, y);
            return fmt::format("{:.17g},{:.17g},0.2,{:.17g}", range, std::atan2(y, x), 0.2 / range);
          }),
          start, "range.csv");
  ASSERT_EQ(by_range.code, 0) << by_range.err;
  EXPECT_EQ(text_of(folder_ / "position.csv"), text_of(folder_ / "range.csv"));
  EXPECT_NE(text_of(folder_ / "position.csv").find("rejected"), std::string::npos);
  const Outcome half = run("t,v,omega,seen_x,seen_y\n0,1,0,,\n0,,,4,\n1,1,0,,\n1,,,4,2\n", start);
  EXPECT_THAT(half.err, HasSubstr("1 lines have an incomplete record of the kind 'sightings'"));
}

// The hint of a log that is not understood names --columns: each command that reads the log has it.
TEST_F(CsvLog, IsReadByMapAndViewToo) {
  std::string csv = "stamp,speed,rate,angle,distance,east,north,heading\n";
  for (int i = 0; i < 200; ++i)
    csv += fmt::format("{0},1000,0,,,{1},0,0\n{0},,,{2},{3},,,\n", 100 * i, 0.1 * i,
                       std::atan2(5, 30 - 0.1 * i), std::hypot(5, 30 - 0.1 * i));
  write_text(folder_ / "drive.csv", csv);
  const std::string columns =
      "t=stamp/1000,v=speed/1000,omega=rate,bearing=angle,range=distance,truth_x=east,truth_y=north,"
      "truth_yaw=heading";
  const Outcome page =
      waymark({"view", map_, "--log", folder_ / "drive.csv", "--columns", columns, "-o", folder_ / "v.html"});
  EXPECT_EQ(page.code, 0) << page.err;
  const Outcome made =
      waymark({"map", folder_ / "drive.csv", "--columns", columns, "-o", folder_ / "made.gpkg"});
  EXPECT_THAT(made.err, testing::Not(HasSubstr("recognised as t"))) << made.err;
}

TEST_F(CsvLog, SaysWhatIsWrong) {
  const auto refusal_of = [&](const std::string& csv, const std::string& columns) {
    const Outcome said = run(csv, {"--start", "0,0,0", "--columns", columns});
    EXPECT_NE(said.code, 0);
    return said.err;
  };
  const std::string csv = "stamp,speed,rate\n0,1,0.1\n1,1,200\n";
  EXPECT_THAT(refusal_of(csv, "v=speed,omega=rate"),
              AllOf(HasSubstr("recognised as t"), HasSubstr("stamp, speed")));
  EXPECT_THAT(refusal_of(csv, "t=stamp,v=speed"), HasSubstr("also need omega"));
  EXPECT_THAT(refusal_of(csv, "t=stamp,range_sd=rate"), HasSubstr("also need bearing or range"));
  EXPECT_THAT(refusal_of(csv, "t=stamp,v=sped,omega=rate"), HasSubstr("speed"));
  EXPECT_THAT(refusal_of(csv, "t=stamp,omga=rate"), HasSubstr("did you mean 'omega'?"));
  EXPECT_THAT(refusal_of(csv, "t=stamp"), HasSubstr("no column of the log is recognised as a reading"));
  EXPECT_THAT(refusal_of(csv, "t=stamp,v=speed,omega=rate"), AllOf(HasSubstr("line 3"), HasSubstr("omega")));
  EXPECT_THAT(refusal_of("t,v,omega\n0,x,0\n", ""), AllOf(HasSubstr("line 2"), HasSubstr("x")));
}

TEST_F(CsvLog, IncompleteRecordsAreCounted) {
  const Outcome said =
      run("t,v,omega\n0,1,0\n1,1,\n,1,0\n2,1,0\n", {"--start", "0,0,0", "--method", "odometry"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("1 lines have an incomplete record of the kind 'odometry'"),
                              HasSubstr("1 lines without a time")));
}

TEST_F(CsvLog, ReadingsOfSeveralSensorsMayShareATable) {
  const Outcome said =
      run("t,v,omega,range,landmark\n0,1,0,,\n0,,,4,x1\n0,,,5,x2\n1,1,0,,\n1,,,4,x1\n2,1,0,,\n",
          {"--start", "0,0,0", "--method", "ekf"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, testing::Not(HasSubstr("run backwards")));
  EXPECT_THAT(said.err + said.out, HasSubstr("3 no such landmark in the map"));
}

TEST_F(CsvLog, TracksForOtherTools) {
  const std::string drive = "t,v,omega\n0,1,0.1\n1,1,0.1\n2,1,0.1\n";
  for (const char* name : {"a.csv", "a.tum", "a.kitti", "a.g2o"})
    ASSERT_EQ(run(drive, {"--start", "1,2,0.5", "--method", "odometry"}, name).code, 0) << name;
  track_ = folder_ / "a.csv";
  const auto last = last_row();
  const auto numbers = [&](const char* name) {
    std::istringstream rows(text_of(folder_ / name));
    std::string row, kept;
    while (std::getline(rows, row)) kept = row;
    std::istringstream cells(kept);
    std::vector<double> values;
    for (double v = 0; cells >> v;) values.push_back(v);
    return values;
  };
  const auto tum = numbers("a.tum"), kitti = numbers("a.kitti");
  ASSERT_EQ(tum.size(), 8U);
  EXPECT_NEAR(tum[1], last.at("x"), 1e-5);
  EXPECT_NEAR(2 * std::atan2(tum[6], tum[7]), last.at("yaw"), 1e-5);
  ASSERT_EQ(kitti.size(), 12U);
  EXPECT_NEAR(kitti[3], last.at("x"), 1e-5);
  EXPECT_NEAR(kitti[7], last.at("y"), 1e-5);
  EXPECT_NEAR(std::atan2(kitti[4], kitti[0]), last.at("yaw"), 1e-5);
  EXPECT_THAT(text_of(folder_ / "a.g2o"), HasSubstr("VERTEX_SE2 0 1.000000 2.000000 0.5"));
  // What is written is read again, and a positional CRS is never left out silently.
  const auto score = [&](const char* name) {
    const Outcome said =
        waymark({"evaluate", "track", folder_ / name, "--truth", folder_ / "a.csv", "--format", "json"});
    EXPECT_EQ(said.code, 0) << name << said.err;
    return nlohmann::json::parse(said.out)["ate_rmse"].get<double>();
  };
  EXPECT_LT(score("a.tum"), 1e-5);
  EXPECT_EQ(score("a.csv"), 0);
  const Outcome by_tum =
      waymark({"evaluate", "track", folder_ / "a.csv", "--truth", folder_ / "a.tum", "--format", "json"});
  EXPECT_LT(nlohmann::json::parse(by_tum.out)["heading_rmse_deg"].get<double>(), 1e-4);
  write_text(folder_ / "bad.tum", "# t x y z qx qy qz qw\n0 1 2 0 0 0 0 1\n1 1 2 0 0 0 0 2\n");
  EXPECT_THAT(waymark({"evaluate", "track", folder_ / "bad.tum", "--truth", folder_ / "a.csv"}).err,
              AllOf(HasSubstr("no pose of TUM"), HasSubstr("bad.tum, line 3")));
  const Outcome in_crs = run(drive, {"--start", "1,2,0.5", "--crs"}, "b.tum");
  EXPECT_EQ(in_crs.code, 2);
  EXPECT_THAT(in_crs.err, HasSubstr("metres of the map frame, not of its CRS"));
  EXPECT_THAT(run(drive, {"--start", "1,2,0.5"}, "a.txt").err,
              HasSubstr(".csv, .gpkg, .tum, .kitti or .g2o"));
}

// The example at the head of docs/reference/log_format.md.
TEST_F(CsvLog, TheExampleOfTheReferencePageRuns) {
  const std::string page = text_of(std::string(WAYMARK_SOURCE_DIR) + "/docs/reference/log_format.md");
  const std::size_t from = page.find("```json\n") + 8;
  const std::string example = page.substr(from, page.find("```", from) - from);
  EXPECT_THAT(example, HasSubstr("sightings"));
  const Outcome said = localize(example, {"--start", "0,0,0"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_GT(rows_, 0);
}

}  // namespace
}  // namespace waymark::test

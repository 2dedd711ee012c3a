// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ExportCommand : public testing::Test {
 protected:
  void SetUp() override {
    write_text(
        folder_ / "rocks.csv",
        "uid,x,y,z,radius,confidence\nsure,500010,5000020,0,0.5,0.9\nmaybe,500012,5000021,0,0.7,0.4\n");
    const Outcome made =
        waymark({"import", folder_ / "rocks.csv", "-o", map_, "--type", "rock", "--map-crs", "EPSG:32632"});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  Outcome run(const std::string& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"export", map_, folder_ / out, "--min-confidence", "0.5"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }

  TempFolder folder_;
  std::string map_ = folder_ / "rocks.gpkg";
};

TEST_F(ExportCommand, DoubtfulLandmarksAreLeftOut) {
  const Outcome table = run("likely.csv");
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_THAT(table.err, HasSubstr("1 rock"));
  EXPECT_THAT(text_of(folder_ / "likely.csv"), AllOf(HasSubstr("sure"), Not(HasSubstr("maybe"))));
  ASSERT_EQ(run("likely.gpkg").code, 0);
  EXPECT_EQ(waymark({"validate", folder_ / "likely.gpkg"}).code, 0);
  EXPECT_THAT(waymark({"query", folder_ / "likely.gpkg", "--format", "csv"}).out,
              AllOf(HasSubstr("sure"), Not(HasSubstr("maybe"))));
  const Outcome robot = run("likely.ini", {"-of", "MRPT"});
  EXPECT_THAT(robot.err, HasSubstr("1 landmarks"));
  ASSERT_EQ(waymark({"export", map_, folder_ / "all.csv"}).code, 0);
  EXPECT_THAT(text_of(folder_ / "all.csv"), HasSubstr("maybe"));
}

TEST_F(ExportCommand, ABoundOfConfidenceIsRefusedWhereItDoesNotApply) {
  EXPECT_EQ(waymark({"export", map_, folder_ / "a.csv", "--min-confidence", "50"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.csv"));
  EXPECT_THAT(run("a.diam").err, HasSubstr("needs all craters"));
}

TEST_F(ExportCommand, AReportMayShowLikelyLandmarksOnly) {
  const auto report = [&](const std::string& map, const char* html, const char* bound) {
    return waymark({"report", map, "-o", folder_ / html, "--min-confidence", bound, "--title", "Rocks"});
  };
  ASSERT_EQ(report(map_, "bound.html", "0.5").code, 0);
  EXPECT_THAT(text_of(folder_ / "bound.html"), AllOf(HasSubstr("sure"), Not(HasSubstr("maybe"))));
  ASSERT_EQ(report(map_, "all.html", "0").code, 0);
  EXPECT_THAT(text_of(folder_ / "all.html"), HasSubstr("maybe"));
  EXPECT_EQ(report(map_, "no.html", "7").code, 2);
  const Outcome none = report(map_, "no.html", "0.95");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("the map has no landmark of confidence 0.95 or more"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "no.html"));
}

}  // namespace
}  // namespace waymark::test

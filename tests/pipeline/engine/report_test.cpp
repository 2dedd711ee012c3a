// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace waymark::test {
using namespace pipeline;
namespace {

RunReport sample() {
  RunReport report;
  report.seconds = 2;
  report.stages.resize(2);
  StageReport& load = report.stages[0];
  load.stage = "load_dem";
  load.units = load.reused = 1;
  load.counts.out = 4;
  load.warnings = {"seams disagree\n  by 3 m"};
  StageReport& find = report.stages[1];
  find.stage = "find_tops";
  find.units = 4;
  find.made = 2;
  find.failed = find.waiting = 1;
  find.counts = {120, 20, {{"below min_prominence", 90}, {"not a top", 10}}};
  find.seconds = 1.234;
  report.failures = {{"find_tops/tile_000002", ErrorCode::input, "torn\n  dem.tif"}};
  return report;
}

TEST(RunReport, IsATableForPeople) {
  std::ostringstream text;
  text << sample();
  EXPECT_EQ(text.str(), R"(stage              in         out    rejected   seconds  units
load_dem            0           4           0      0.00  1, 1 reused
    warning: seams disagree
      by 3 m
find_tops         120          20         100      1.23  4, 1 failed, 1 waiting
    90 below min_prominence
    10 not a top
failed: find_tops/tile_000002
    torn
      dem.tif
)");
}

TEST(RunReport, IsJsonForPrograms) {
  const auto json = nlohmann::json::parse(report_as_json(sample()));
  EXPECT_EQ(json["stages"][1]["rejected"]["below min_prominence"], 90);
  EXPECT_EQ(json["stages"][1]["in"], 120);
  EXPECT_EQ(json["failures"][0]["unit"], "find_tops/tile_000002");
  EXPECT_EQ(json["seconds"], 2.0);
}

TEST(RunReport, TextThatIsNotUtf8DoesNoHarm) {
  RunReport report = sample();
  report.stages[0].warnings = {"\xff.tif is odd"};
  EXPECT_NO_THROW(report_as_json(report));
}

TEST(RunReport, IsCompleteWhenEveryUnitHasAResult) {
  EXPECT_FALSE(sample().complete());
  EXPECT_EQ(sample().exit_code(), 3);
  EXPECT_TRUE(RunReport{}.complete());
  EXPECT_EQ(RunReport{}.exit_code(), 0);
  RunReport refused = sample();
  refused.failures.push_back(
      {"measure_isolation/map", ErrorCode::usage, "planar isolation needs a projected DEM"});
  EXPECT_EQ(refused.exit_code(), 2);
}

}  // namespace
}  // namespace waymark::test

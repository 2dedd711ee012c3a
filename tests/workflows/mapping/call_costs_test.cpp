// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/call_costs.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace waymark::test {
using namespace workflows;
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A stage that lists tiles, one over ten tiles, one that joins them.
pipeline::Plan ten_tiles(bool listed = true) {
  pipeline::Plan plan;
  const auto add = [&](const std::string& stage, std::size_t units, bool done) {
    for (std::size_t i = 0; i < units; ++i) {
      pipeline::Unit unit{
          .stage = stage, .item = "map", .tile = {}, .image = {}, .fingerprint = {}, .after = {}};
      if (units > 1) unit.tile = pipeline::Tile{.index = static_cast<std::int64_t>(i), .cells = {}};
      unit.done = done;
      plan.units.push_back(unit);
    }
    plan.begins.push_back(plan.units.size());
  };
  add("list", 1, listed), add("find", 10, false), add("join", 1, false);
  return plan;
}

pipeline::StageReport made(const std::string& stage, std::int64_t units, double seconds) {
  pipeline::StageReport report;
  report.stage = stage, report.made = units, report.seconds = seconds;
  return report;
}

class CallCosts : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  pipeline::RunOptions options(int threads = 3) const {
    pipeline::RunOptions all;
    all.work = folder_, all.threads = threads;
    return all;
  }
  MeasuredResources measured(std::size_t shards, bool listed = true) const {
    return measured_resources(folder_, ten_tiles(listed), shards);
  }
  const std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) /
                                        testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(CallCosts, AreUnknownBeforeARun) {
  EXPECT_THAT(measured(4).unknown, ElementsAre("find", "join", "map"));
  EXPECT_THAT(measured(4, false).unknown, ElementsAre("list", "find", "join", "map"));
  EXPECT_THAT(measured(4).by_stage, IsEmpty());
}

TEST_F(CallCosts, GrowWithTheUnitsOfACall) {
  // 40 s of each unit, 20 s of the call itself.
  keep_costs(options(),
             {.stages = {made("find", 5, 200), made("join", 0, 7)}, .failures = {}, .seconds = 220});
  const MeasuredResources ten = measured(10), four = measured(4), one = measured(1);
  EXPECT_THAT(ten.unknown, ElementsAre("join", "map"));
  EXPECT_EQ(ten.by_stage.at("find").minutes, 3);   // 3 * (20 + 40) s
  EXPECT_EQ(four.by_stage.at("find").minutes, 7);  // 3 * (20 + 3 * 40) s
  EXPECT_EQ(one.by_stage.at("find").minutes, 21);  // 3 * (20 + 10 * 40) s
  EXPECT_EQ(ten.by_stage.at("find").processors, 3);
  EXPECT_GE(ten.by_stage.at("find").megabytes, 100);
  EXPECT_EQ(ten.by_stage.at("find").megabytes % 100, 0);
}

TEST_F(CallCosts, AreTheLargestOfAllParts) {
  pipeline::RunOptions part = options(1);
  for (const auto& [index, seconds] : {std::pair{1, 30.0}, {2, 300.0}, {3, 60.0}}) {
    part.shard = pipeline::Shard{index, 3};
    keep_costs(part, {.stages = {made("find", 1, seconds)}, .failures = {}, .seconds = seconds});
  }
  EXPECT_EQ(measured(10).by_stage.at("find").minutes, 15);
  std::ofstream(folder_ / "costs/find/4_of_3.json") << "{\"megabytes\": -1";  // damaged: not read
  EXPECT_EQ(measured(10).by_stage.at("find").minutes, 15);
}

TEST_F(CallCosts, OfTheMapAreThoseOfWritingIt) {
  keep_cost_of_map(options(), {.stages = {}, .failures = {}, .seconds = 10}, 50);
  EXPECT_EQ(measured(4).by_stage.at("map").minutes, 3);
}

TEST_F(CallCosts, AreNotKeptWithoutAWorkFolder) {
  pipeline::RunOptions nowhere = options();
  nowhere.work.clear();
  keep_costs(nowhere, {.stages = {made("find", 5, 200)}, .failures = {}, .seconds = 200});
  EXPECT_THAT(measured(4).by_stage, IsEmpty());
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// The rules themselves: their faults, and those that come with the program.
#include <gmock/gmock.h>

#include <cmath>

#include "tests/apps/commands/import_rules_fixture.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(ImportRules, FaultsOfRulesAreNamed) {
  const auto fault = [&](const std::string& text) {
    const Outcome said = import(kTown, "town.osm", {"--rules", rules(text)});
    EXPECT_NE(said.code, 0);
    return said.err;
  };
  EXPECT_THAT(fault(R"({"type": "lamp"})"), HasSubstr("lamp"));
  EXPECT_THAT(fault(R"({"type": "pole", "wher": {}})"), HasSubstr("wher"));
  EXPECT_THAT(fault(R"({"type": "pole", "features": {"hight": "height"}})"),
              HasSubstr("pole has no feature 'hight'"));
  EXPECT_THAT(fault(R"({"type": "pole", "features": {"height": "2*("}})"),
              HasSubstr("the expression ends too early"));
  EXPECT_THAT(fault(R"({"type": "pole", "geometry": "middle"})"), HasSubstr("it is one of"));
  const std::string none = fault(R"({"type": "pole", "where": {"highway": "lamp"}})");
  EXPECT_THAT(none, HasSubstr("none of the 5 elements matches a rule"));
  EXPECT_THAT(none, HasSubstr("building (3), height (2)"));
  const Outcome unknown = import(kTown, "town.osm", {"--rules", "osn"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there are no ready rules 'osn'"));
  const Outcome both = import(kTown, "town.osm", {"--rules", "osm", "--type", "pole"});
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("--type is for tables"));
}

TEST_F(ImportRules, ReadyRulesCanBePrintedAndReadAgain) {
  for (const char* name : {"osm", "lanelet2", "trees", "lamps", "cityjson", "floor_plan"}) {
    const Outcome printed = waymark({"import", "--rules", name, "--print-rules"});
    ASSERT_EQ(printed.code, 0) << printed.err;
    EXPECT_TRUE(json::accept(printed.out)) << name;
  }
}

// Lanelet2 does not say which side of a kerb is lower.
TEST_F(ImportRules, AKerbOfLanelet2MayFaceEitherSide) {
  const Outcome said = import(R"(<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
 <node id='1' lat='49.0000000' lon='8.4000000'/> <node id='2' lat='49.0000000' lon='8.4001367'/>
 <way id='20'><nd ref='1'/><nd ref='2'/><tag k='type' v='curbstone'/><tag k='subtype' v='high'/>
  <tag k='height' v='0.12'/></way>
</osm>
)",
                              "road.osm", {"--rules", "lanelet2"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json kerbs = landmarks("curb");
  ASSERT_EQ(kerbs.size(), 2U);
  double turns = 0;
  for (const json& kerb : kerbs) {
    EXPECT_NEAR(kerb["length"], 10, 0.05);
    EXPECT_EQ(kerb["height"], 0.12);
    EXPECT_EQ(kerb["confidence"], 0.5);
    EXPECT_NEAR(std::abs(std::cos(double(kerb["direction"]))), 1, 1e-3);
    turns += std::cos(double(kerb["direction"]));
  }
  EXPECT_NEAR(turns, 0, 1e-6);  // one faces north, the other south
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

}  // namespace
}  // namespace waymark::test

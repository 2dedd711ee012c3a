// SPDX-License-Identifier: Apache-2.0
// The rules themselves: their faults, and those that come with the program.
#include <gmock/gmock.h>

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

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// `waymark merge` as people call it, and what it refuses.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class MergeCommand : public testing::Test {
 protected:
  std::string map(const std::string& name, const std::string& rows, const std::string& crs = "EPSG:32633") {
    write_text(folder_ / (name + ".csv"), "uid,x,y,z,radius,height\n" + rows);
    const std::string file = folder_ / (name + ".gpkg");
    const Outcome made =
        waymark({"import", folder_ / (name + ".csv"), "-o", file, "--type", "rock", "--map-crs", crs,
                 "--columns", "position_sd=0.1,uid=uid,x=x,y=y,z=z,radius=radius,height=height"});
    EXPECT_EQ(made.code, 0) << made.err;
    return file;
  }
  Outcome merge(std::vector<std::string> maps) {
    maps.insert(maps.begin(), "merge");
    maps.insert(maps.end(), {"-o", result_});
    return waymark(maps);
  }
  void expect_refusal(const std::vector<std::string>& maps, int code, const std::string& text) {
    const Outcome said = merge(maps);
    EXPECT_EQ(said.code, code) << said.err;
    EXPECT_THAT(said.err, HasSubstr(text));
    EXPECT_FALSE(std::filesystem::exists(result_));
  }

  TempFolder folder_;
  std::string result_ = folder_ / "merged.gpkg";
};

TEST_F(MergeCommand, OneMapOfTwo) {
  const std::string a = map("a", "r1,10,20,0,0.5,0.4\nr2,30,20,0,0.8,0.5\n");
  const std::string b = map("b", "r1,50,20,0,0.6,0.4\nr7,10.1,20,0,0.52,0.4\n");
  const Outcome said = merge({a, b});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("3 landmarks of 2 maps; 1 fused, 0 identical"));
  EXPECT_EQ(waymark({"validate", result_}).code, 0);
  const json rocks = json::parse(waymark({"query", result_, "--format", "json"}).out);
  EXPECT_EQ(rocks.size(), 3u);
  const std::string ab = text_of(result_);
  ASSERT_EQ(merge({b, a}).code, 0);
  EXPECT_TRUE(text_of(result_) == ab);
}

TEST_F(MergeCommand, BadInputIsRefused) {
  const std::string a = map("a", "r1,10,20,0,0.5,0.4\n"), b = map("b", "r1,10,20,0,0.5,0.4\n", "EPSG:32632");
  const std::string plane = map("plane", "r1,10,20,0,0.5,0.4\n", "local");
  expect_refusal({a}, 2, "two maps or more");
  expect_refusal({a, b}, 2, "--crs EPSG:3263");
  expect_refusal({a, plane}, 2, "waymark register");
  expect_refusal({a, folder_ / "none.gpkg"}, 1, "none.gpkg");
  expect_refusal({a, folder_ / "a.csv"}, 1, "a.csv");
  write_text(folder_ / "empty.gpkg", "");
  expect_refusal({a, folder_ / "empty.gpkg"}, 1, "empty.gpkg");
  ASSERT_EQ(bash("sqlite3 '" + b +
                 "' \"SELECT 'DROP TRIGGER ' || quote(name) || ';' FROM sqlite_master WHERE "
                 "type = 'trigger'\" | sqlite3 '" +
                 b + "' && sqlite3 '" + b + "' 'UPDATE rock SET confidence = 7'")
                .code,
            0);
  expect_refusal({b, b}, 1, "confidence");
  const std::string before = text_of(a);
  EXPECT_EQ(waymark({"merge", a, plane, "-o", a}).code, 2);
  EXPECT_TRUE(text_of(a) == before);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
// Corrections of a map by hand, through the program.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class EditCommand : public testing::Test {
 protected:
  EditCommand() {
    write_text(folder_ / "craters.csv",
               "x,y,z,radius,confidence\n0,0,1,3,0.4\n100,0,2,5,0.5\n0,100,3,8,0.6\n");
    const Outcome made = waymark(
        {"import", folder_ / "craters.csv", "-o", map_, "--type", "crater", "--map-crs", "EPSG:32633"});
    EXPECT_EQ(made.code, 0) << made.err;
  }

  Outcome edit(std::vector<std::string> words) {
    words.insert(words.begin(), {"edit", map_});
    const Outcome said = waymark(words);
    EXPECT_EQ(waymark({"validate", map_}).code, 0);
    return said;
  }
  json landmarks() {
    const Outcome all = waymark({"query", map_, "--type", "crater", "--format", "json"});
    return json::parse(all.out);
  }
  std::string uid_near(double x, double y) {
    const Outcome all =
        waymark({"query", map_, "--format", "json", "--near", std::to_string(x), std::to_string(y), "1"});
    return json::parse(all.out).at(0).at("uid").get<std::string>();
  }
  json landmark(const std::string& uid) {
    for (const json& l : landmarks())
      if (l["uid"] == uid) return l;
    return {};
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg";
};

TEST_F(EditCommand, AcceptsAndRestoreTakesItBack) {
  const std::string uid = uid_near(0, 0);
  const Outcome said = edit({"accept", uid});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(said.out, uid + "\n");
  EXPECT_DOUBLE_EQ(landmark(uid)["confidence"], 0.99);
  EXPECT_DOUBLE_EQ(landmark(uid)["radius"], 3);
  ASSERT_EQ(waymark({"restore", map_}).code, 0);
  EXPECT_DOUBLE_EQ(landmark(uid)["confidence"], 0.4);
}

TEST_F(EditCommand, RejectsAllOrNone) {
  const std::string first = uid_near(0, 0), second = uid_near(100, 0);
  EXPECT_EQ(edit({"reject", first, "crater-nowhere"}).code, 2);
  EXPECT_EQ(landmarks().size(), 3);
  EXPECT_EQ(edit({"reject", first, second, "--reason", "shadows"}).code, 0);
  EXPECT_EQ(landmarks().size(), 1);
  EXPECT_THAT(bash("ogrinfo -ro -q '" + map_ + "' run").out, HasSubstr("shadows"));
}

TEST_F(EditCommand, ACraterIsAddedByThreePointsOfItsRim) {
  const Outcome said = edit(
      {"add", "--type", "crater", "--rim", "60", "50", "50", "60", "40", "50", "--feature", "depth=1.5"});
  ASSERT_EQ(said.code, 0) << said.err;
  const json added = landmark(said.out.substr(0, said.out.size() - 1));
  EXPECT_NEAR(added["x"], 50, 1e-9);
  EXPECT_NEAR(added["y"], 50, 1e-9);
  EXPECT_NEAR(added["radius"], 10, 1e-9);
  EXPECT_DOUBLE_EQ(added["depth"], 1.5);
  EXPECT_TRUE(added["quality"].is_null()) << "no image assesses it";
  const Outcome again = edit({"add", "--type", "crater", "--at", "50", "50"});
  EXPECT_EQ(again.code, 0) << "a second one of that place gets a uid of its own: " << again.err;
  EXPECT_EQ(landmarks().size(), 5);
}

TEST_F(EditCommand, MovesIntoAnotherMap) {
  const std::string uid = uid_near(0, 100), other = folder_ / "moved.gpkg", before = text_of(map_);
  ASSERT_EQ(edit({"move", uid, "--at", "-2", "101.5", "--position-sd", "0.1", "-o", other}).code, 0);
  EXPECT_EQ(text_of(map_), before);
  map_ = other;
  const json moved = landmark(uid);
  EXPECT_DOUBLE_EQ(moved["x"], -2);
  EXPECT_DOUBLE_EQ(moved["y"], 101.5);
  EXPECT_DOUBLE_EQ(moved["z"], 3);
  EXPECT_NEAR(moved["var_x"], 0.01, 1e-12);
  EXPECT_EQ(landmarks().size(), 3);
}

TEST_F(EditCommand, RefusesWhatCannotBe) {
  const std::string uid = uid_near(0, 0), before = text_of(map_);
  for (const auto& [words, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"accept"}, "no landmark is named"},
           {{"accept", "crater-nowhere"}, "no landmark 'crater-nowhere'"},
           {{"accept", uid, "--confidence", "0"}, "--confidence = 0 is outside [1e-06, 1]"},
           {{"move", uid}, "a position is needed"},
           {{"accept", uid, "--at", "1", "2"}, "--at is an option of add and move"},
           {{"accept", uid, "--feature", "radius=9"}, "--feature is an option of add"},
           {{"reject", uid, "--z", "5"}, "--z is an option of add and move"},
           {{"reject", uid, "--confidence", "0.5"}, "--confidence is an option of accept and add"},
           {{"move", uid, "--at", "1", "2", "--type", "rock"}, "--type is an option of add"},
           {{"move", uid, "--at", "1"}, "--at takes 2 values"},
           {{"add", "--at", "1", "2"}, "--type"},
           {{"add", "--type", "yeti", "--at", "1", "2"}, "no landmarks of type 'yeti'"},
           {{"add", "--type", "crater", "--rim", "0", "0", "1", "1", "2", "2"}, "lie on a line"},
           {{"add", "--type", "crater", "--at", "1", "2", "--feature", "radios=2"}, "did you mean 'radius'"},
           {{"add", "--type", "crater", "--at", "1", "2", "--feature", "radius=-2"},
            "radius of a crater = -2 is outside ["}}) {
    const Outcome said = edit(words);
    EXPECT_EQ(said.code, 2) << why << said.err;
    EXPECT_THAT(said.err, HasSubstr(why));
  }
  EXPECT_EQ(text_of(map_), before);
}

}  // namespace
}  // namespace waymark::test

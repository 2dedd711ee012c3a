// SPDX-License-Identifier: Apache-2.0
#include "planning/vehicle.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"

namespace waymark::test {
namespace {

using namespace planning;
using testing::HasSubstr;

std::string file_of(const std::string& supports, const std::string& more = "") {
  return R"({"waymark_vehicle": 1)" + more + R"(, "supports": [)" + supports + "]}";
}

std::string message_of(const std::string& json) {
  try {
    parse_vehicle(json, "cart", "cart.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

constexpr const char* kCart = R"({"x": 1, "y": 0.5, "diameter": 0.4, "width": 0.2},
  {"x": 1, "y": -0.5, "diameter": 0.4, "width": 0.2}, {"x": -1, "y": 0, "diameter": 0.6})";

TEST(Vehicle, BaseHoldsAllSupports) {
  const Vehicle cart = parse_vehicle(file_of(kCart), "cart", "cart.json");
  EXPECT_DOUBLE_EQ(cart.base_radius(), std::hypot(1, 0.6));
  EXPECT_DOUBLE_EQ(cart.support_diameter(), 0.4);
  EXPECT_DOUBLE_EQ(cart.track_width(), 1.2);
  EXPECT_EQ(cart.supports[2].width, cart.supports[2].diameter);
}

TEST(Vehicle, BuiltInsAreSoundAndSorted) {
  std::vector<std::string> names;
  for (const Vehicle& vehicle : built_in_vehicles()) {
    names.push_back(vehicle.name);
    EXPECT_FALSE(vehicle.summary.empty());
    EXPECT_GT(vehicle.base_radius(), 0.2);
  }
  EXPECT_THAT(names, testing::ElementsAre("field_robot", "harvester", "lander", "rover"));
}

TEST(Vehicle, MissingWheelIsNamed) {
  EXPECT_THAT(message_of(file_of(R"({"x": 1, "y": 0.5, "diameter": 0.4},
    {"x": -1, "y": 0.5, "diameter": 0.4}, {"x": -1, "y": -0.5, "diameter": 0.4})")),
              HasSubstr("the support at x = 1 m, y = 0.5 m has none opposite"));
  EXPECT_THAT(message_of(file_of(R"({"x": 0, "y": 0, "diameter": 0.4})")),
              HasSubstr("three supports or more"));
  EXPECT_THAT(message_of(file_of(R"({"x": 1, "diameter": 0.4})")), HasSubstr("supports[0] has no 'y'"));
}

TEST(Vehicle, BadFilesAreRefused) {
  EXPECT_THAT(message_of("{}"), HasSubstr("this is no vehicle file"));
  EXPECT_THAT(message_of("[1"), HasSubstr("not valid JSON"));
  EXPECT_THAT(message_of(R"({"waymark_vehicle": 2})"), HasSubstr("version"));
  EXPECT_THAT(message_of(file_of(kCart, R"(, "max_slop": 3)")), HasSubstr("max_slope"));
  EXPECT_THAT(message_of(file_of(kCart, R"(, "max_slope": 95)")), HasSubstr("outside"));
}

TEST(Vehicle, UnknownNameGetsTheNearest) {
  try {
    find_vehicle("rovr");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'rover'?"));
  }
}

}  // namespace
}  // namespace waymark::test

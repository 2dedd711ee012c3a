// SPDX-License-Identifier: Apache-2.0
#include "workflows/sensor_file.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/error.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kMine = R"({"waymark_sensor": 1, "summary": "Mine",
  "weights": {"rock": {"radius": 0.7, "height": 0.3}, "lamp_post": {"height": 1}},
  "coverage": {"range": 12, "view": 90, "range_sd": 0.2, "bearing_sd": 1, "detection": 0.6,
               "detection_odds": {"intercept": 3, "per_metre": -0.2, "per_log_diameter": 1}}})";

std::string refusal_of_sensor(const std::string& from, const std::string& to) {
  std::string text = kMine;
  text.replace(text.find(from), from.size(), to);
  try {
    parse_sensor(text, "mine", "mine.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  ADD_FAILURE() << "not refused: " << to;
  return {};
}

TEST(SensorFile, IsReadAndWrittenAlike) {
  const SensorProfile mine = parse_sensor(kMine, "mine", "mine.json");
  EXPECT_EQ(mine.name, "mine");
  ASSERT_EQ(mine.weights.size(), 3u);
  EXPECT_DOUBLE_EQ(mine.weights[0].weight, 0.7);
  EXPECT_DOUBLE_EQ(mine.coverage.range, 12);
  EXPECT_DOUBLE_EQ(detection_probability(mine.coverage, 10, 0.5),
                   1 / (1 + std::exp(-(3 - 0.2 * 10 + std::log(0.5)))));
  EXPECT_DOUBLE_EQ(detection_probability(mine.coverage, 10, 0), 0.6) << "a diameter that is unknown";
  const std::string written = sensor_as_json(mine);
  EXPECT_EQ(sensor_as_json(parse_sensor(written, "mine", "again.json")), written);
}

TEST(SensorFile, BuiltInProfilesAreFiles) {
  for (const SensorProfile& built_in : all_sensors()) {
    const SensorProfile read = parse_sensor(sensor_as_json(built_in), built_in.name, built_in.name);
    const LandmarkType& rock = all_types()[all_types().id("rock")];
    Landmark landmark;
    landmark.quality = {.seen = 4, .visible = 5, .feature_confidences = {}};
    landmark.quality.feature_confidences.resize(rock.features.size());
    landmark.quality.feature_confidences[0] = 0.9;
    landmark.quality.feature_confidences[1] = 0.5;
    EXPECT_NEAR(quality_for(read, rock, landmark).value_or(-1),
                quality_for(built_in, rock, landmark).value_or(-1), 1e-6)
        << built_in.name;
  }
}

TEST(SensorFile, SaysWhatIsWrong) {
  EXPECT_THAT(refusal_of_sensor("0.7", "0.5"),
              AllOf(HasSubstr("mine.json"), HasSubstr("the weights of rock sum to 0.8")));
  EXPECT_THAT(refusal_of_sensor("0.7", "-0.7"), HasSubstr("weights.rock.radius = -0.7 is outside [0, 1]"));
  EXPECT_THAT(refusal_of_sensor("\"radius\"", "\"raduis\""), HasSubstr("did you mean 'radius'?"));
  EXPECT_THAT(refusal_of_sensor("\"view\": 90", "\"view\": 500"), HasSubstr("coverage.view"));
  EXPECT_THAT(refusal_of_sensor("\"range_sd\"", "\"rangesd\""), HasSubstr("did you mean 'range_sd'?"));
  EXPECT_THAT(refusal_of_sensor("\"waymark_sensor\": 1", "\"waymark_sensor\": 2"), HasSubstr("version"));
}

TEST(SensorFile, AnUnknownNameHasTheNearest) {
  try {
    find_sensor("stereo_camra");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'stereo_camera'?"));
  }
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "core/error.hpp"

namespace waymark::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

FeatureSpec length_feature(const std::string& name) {
  return {.name = name, .unit = "m", .summary = {}};
}

const LandmarkType kPost{
    .name = "post", .summary = {}, .features = {length_feature("height"), length_feature("width")}};

Landmark post(std::optional<double> height, std::optional<double> width) {
  Landmark landmark;
  landmark.quality = {.seen = 4, .visible = 5, .feature_confidences = {height, width}};
  return landmark;
}

TEST(SensorProfile, UnlistedFeaturesHaveNoWeight) {
  EXPECT_THAT(weights_for({"laser", "", {{"post", "width", 2}}}, kPost), ElementsAre(0, 2));
}

TEST(SensorProfile, AnUnlistedTypeHasEqualWeights) {
  EXPECT_THAT(weights_for({"laser", "", {{"rock", "radius", 1}}}, kPost), ElementsAre(1, 1));
}

TEST(SensorProfile, QualityIsWeightedForTheSensor) {  // eq. 8: 4/5 times the weighted mean
  const SensorProfile laser{"laser", "", {{"post", "height", 1}, {"post", "width", 3}}};
  EXPECT_DOUBLE_EQ(quality_for(laser, kPost, post(0.5, 0.9)).value(), 0.8 * (0.5 + 3 * 0.9) / 4);
  EXPECT_DOUBLE_EQ(quality_of(kPost, post(0.5, 0.9)).value(), 0.8 * 0.7);
}

TEST(SensorProfile, AnUnknownConfidenceIsLeftOut) {
  const SensorProfile laser{"laser", "", {{"post", "height", 1}, {"post", "width", 3}}};
  EXPECT_DOUBLE_EQ(quality_for(laser, kPost, post({}, 0.9)).value(), 0.8 * 0.9);
  EXPECT_DOUBLE_EQ(quality_for(laser, kPost, post({}, {})).value(), 0.8);
}

TEST(SensorProfile, ALandmarkThatNoImageCoversHasNoQuality) {
  EXPECT_EQ(quality_of(kPost, Landmark{}), std::nullopt);
}

// Eq. 8 would give 1 to what was seen by the one image that covers it, above all that two images agree on.
TEST(SensorProfile, SeenOnceOfOnceIsNoAssessment) {
  Landmark once = post({}, {});
  once.quality.seen = once.quality.visible = 1;
  EXPECT_EQ(quality_of(kPost, once), std::nullopt);
  once.quality.visible = 2;
  EXPECT_DOUBLE_EQ(quality_of(kPost, once).value(), 0.5);  // another image could have shown it and did not
  once.quality = {.seen = 1, .visible = 1, .feature_confidences = {1.0, 1.0}};
  EXPECT_DOUBLE_EQ(quality_of(kPost, once).value(),
                   1);  // the paper's q_f of one observation: eq. 8 by the letter
  const SensorProfile laser{"laser", "", {{"post", "width", 1}}};
  once.quality.feature_confidences = {0.9, std::nullopt};
  EXPECT_EQ(quality_for(laser, kPost, once), std::nullopt);  // the sensor cannot see what was assessed
}

TEST(SensorRegistry, RejectsInvalidProfiles) {
  SensorRegistry sensors;
  sensors.add({"laser", "", {}});
  EXPECT_THROW(sensors.add({"laser", "", {}}), std::logic_error);
  EXPECT_THROW(sensors.add({"", "", {}}), std::logic_error);
  EXPECT_THROW(sensors.add({"odd", "", {{"post", "height", -1}}}), std::logic_error);
}

TEST(SensorRegistry, NamesTheNearest) {
  SensorRegistry sensors;
  register_sensor_profiles(sensors);
  try {
    sensors.at("stereo_camra");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'stereo_camera'?"));
  }
}

TEST(SensorRegistry, ShippedProfilesNameFeaturesThatExist) {
  SensorRegistry sensors;
  register_sensor_profiles(sensors);
  TypeRegistry types;
  register_landmark_types(types);
  EXPECT_THAT(sensors.names(), ElementsAre("bearing_camera", "descent_camera", "harvester_laser",
                                           "horizontal_laser", "stereo_camera"));
  for (const SensorProfile& sensor : sensors)
    for (const FeatureWeight& weight : sensor.weights)
      EXPECT_NO_THROW(feature_index(types[types.id(weight.type)], weight.feature)) << sensor.name;
}

}  // namespace
}  // namespace waymark::test

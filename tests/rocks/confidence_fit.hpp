// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/rocks/rock_evidence.hpp"
#include "tests/rocks/rock_scene.hpp"
namespace waymark::testing {

/// A dark spot of a drawn scene: what was seen of it, and whether it is a rock's shadow.
struct ConfidenceSample {
  int scene = 0;
  bool rock = false;
  double diameter = 0;  ///< measured, px
  RockEvidence evidence{};
};

/// A scene with everything drawn at random: sun, relief, dunes, craters, haze, blur, noise, rocks.
RockScene random_scene(int number);

/// The dark spots of random_scene(number) or, for `made`, of made_view(number), judged as the detector would
/// that half of the time is told the sun's elevation and has a direction of light that is wrong by a few
/// degrees.
std::vector<ConfidenceSample> confidence_samples(int number, bool made);

/// Fits the network of rock_confidence (Adam, fixed number of rounds, numbers from a fixed seed) and writes
/// it as the source file pipeline/rocks/rock_confidence_weights.hpp.
std::string fit_confidence(const std::vector<ConfidenceSample>& samples);

}  // namespace waymark::testing

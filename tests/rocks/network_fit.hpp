// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/rocks/rock_evidence.hpp"
#include "tests/rocks/made_view.hpp"
#include "tests/rocks/rock_scene.hpp"
namespace waymark::testing {

/// A dark spot of a made scene: what was seen of it, whether it is a rock's shadow, and what a network ought
/// to say of that rock (RockJudgement).
struct NetworkSample {
  bool rock = false;
  RockEvidence evidence{};
  double log_radius = 0, log_reach = 0, along = 0, across = 0;
};

/// A scene with everything drawn at random: sun, relief, dunes, craters, haze, blur, noise, rocks.
RockScene random_scene(int number);

/// Large rocks of one shape, or of all, under a sun 13 to 28 degrees high; the rest at random.
RockScene low_sun_scene(int number);

/// A scene as a view.
MadeView drawn_view(const RockScene& scene);

/// The dark spots of a view, judged as the detector would that half of the time is told the sun's elevation
/// and has a direction of light that is wrong by a few degrees; `number` seeds what it is told. At most
/// `most` of them, at random: scenes count alike, crowded or bare.
std::vector<NetworkSample> network_samples(const MadeView& view, int number, std::size_t most);

/// The numbers of pipeline/rocks/rock_network.hpp.
struct FittedNetwork {
  double share_of_rocks = 0;
  std::vector<float> mean, sd, hidden, out;
};

/// Fits the network of judge_rock (Adam, fixed number of rounds, numbers from a fixed seed).
FittedNetwork fit_network(const std::vector<NetworkSample>& samples);

/// The network whose outputs are the means of those of two: what a fit owes to chance and to the choice of
/// lessons is halved. Inputs are standardised as the first does.
FittedNetwork joined(const FittedNetwork& a, const FittedNetwork& b);

/// As the source file pipeline/rocks/rock_network.hpp.
std::string source_of(const FittedNetwork& network);

}  // namespace waymark::testing

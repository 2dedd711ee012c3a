// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/rocks/rock_evidence.hpp"
#include "tests/pipeline/rocks/rock_scene.hpp"
#include "tests/pipeline/rocks/synthetic_view.hpp"
namespace waymark::test {
using namespace pipeline;

/// Dark spot of a synthetic scene: its evidence, whether it is a rock shadow, and the target outputs
/// (RockPrediction).
struct NetworkSample {
  bool rock = false;
  RockEvidence evidence{};
  double log_radius = 0, log_reach = 0, along = 0, across = 0;
};

/// Scene with random sun, relief, dunes, craters, haze, blur, noise and rocks.
RockScene random_scene(int number);

/// Large rocks of one shape, or of all, under a sun 13 to 28 degrees high; the rest at random.
RockScene low_sun_scene(int number);

/// Converts a scene to a view.
SyntheticView scene_view(const RockScene& scene);

/// Returns the dark spots of a view as the detector assesses them, with the sun elevation known half of the
/// time and the sun direction off by a few degrees, seeded by `number`. At most `most`, chosen at random,
/// so that scenes have equal weight.
std::vector<NetworkSample> rock_samples(const SyntheticView& view, int number, std::size_t most);

/// Parameters of pipeline/rocks/rock_network.hpp.
struct FittedNetwork {
  double rock_prior = 0;
  std::vector<float> mean, sd, hidden, out;
};

/// Fits the network of predict_rock (Adam, fixed number of rounds, fixed seed).
FittedNetwork fit_network(const std::vector<NetworkSample>& samples);

/// Returns a network whose outputs are the means of two networks, which halves the variance from training.
/// Inputs are standardised as in the first.
FittedNetwork average_networks(const FittedNetwork& a, const FittedNetwork& b);

/// Returns the network as the source file pipeline/rocks/rock_network.hpp.
std::string source_of(const FittedNetwork& network);

}  // namespace waymark::test

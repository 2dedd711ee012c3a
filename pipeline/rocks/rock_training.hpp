// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "pipeline/rocks/rock_network.hpp"
namespace waymark::pipeline {

/// Dark spot of a synthetic scene: its evidence, whether it is a rock shadow, and the target outputs
/// (RockPrediction).
struct RockExample {
  bool rock = false;
  RockEvidence evidence{};
  double log_radius = 0, log_reach = 0, along = 0, across = 0;
};

struct RockTraining {
  int rounds = 40;  ///< epochs
  std::uint64_t seed = 1;
};

/// Trains a network of 48 units (Adam; Kingma & Ba 2015). Deterministic for the same examples and seed. At
/// least one batch of 64 examples. One thread; 40 rounds of 200 000 examples take about five minutes.
RockNetwork train_rock_network(const std::vector<RockExample>& examples, const RockTraining& training);

/// Returns a network whose outputs are the means of two networks, which halves the variance from training.
/// Inputs are standardised as in the first.
RockNetwork average_networks(const RockNetwork& a, const RockNetwork& b);

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "pipeline/vision/network_text.hpp"
namespace waymark::pipeline {
namespace {

// The layers of RockNetwork have the outputs innermost, those of StoredNetwork the inputs.
StoredLayer store_layer(const std::vector<float>& numbers, std::size_t inputs, std::size_t outputs) {
  StoredLayer layer{{static_cast<int>(inputs), static_cast<int>(outputs)}, {}, {}};
  for (std::size_t o = 0; o < outputs; ++o) {
    layer.biases.push_back(static_cast<double>(numbers[inputs * outputs + o]));
    for (std::size_t i = 0; i < inputs; ++i)
      layer.weights.push_back(static_cast<double>(numbers[i * outputs + o]));
  }
  return layer;
}

std::vector<float> load_layer(const StoredLayer& layer) {
  const auto inputs = static_cast<std::size_t>(layer.inputs()), outputs = layer.biases.size();
  std::vector<float> numbers;
  for (std::size_t i = 0; i < inputs; ++i)
    for (std::size_t o = 0; o < outputs; ++o)
      numbers.push_back(static_cast<float>(layer.weights[o * inputs + i]));
  const std::vector<float> biases = as_floats(layer.biases);
  numbers.insert(numbers.end(), biases.begin(), biases.end());
  return numbers;
}

}  // namespace

RockPrediction predict_rock(const RockNetwork& network, const RockEvidence& evidence) {
  const std::size_t units = network.units();
  assert(units <= kMaxRockUnits && network.out.size() == kRockOutputs * (units + 1));
  // Input by input, so that the sums of all units vectorise.
  std::array<float, kMaxRockUnits> unit;
  std::copy_n(&network.hidden[units * kEvidenceCount], units, unit.begin());
  for (std::size_t i = 0; i < kEvidenceCount; ++i) {
    const float in =
        std::clamp((static_cast<float>(evidence[i]) - network.mean[i]) / network.sd[i], -6.0F, 6.0F);
    const float* weight = &network.hidden[units * i];
    for (std::size_t h = 0; h < units; ++h) unit[h] += weight[h] * in;
  }
  std::array<float, kRockOutputs> out;
  std::copy_n(&network.out[kRockOutputs * units], kRockOutputs, out.begin());
  for (std::size_t h = 0; h < units; ++h) {
    const float value = std::tanh(unit[h]);
    for (std::size_t o = 0; o < kRockOutputs; ++o) out[o] += network.out[kRockOutputs * h + o] * value;
  }
  const auto sd = [&](std::size_t o) { return std::exp(std::clamp(static_cast<double>(out[o]), -4.0, 1.0)); };
  const auto factor = [&](std::size_t o) { return std::clamp(static_cast<double>(out[o]), -1.5, 1.5); };
  return {.confidence = 1 / (1 + std::exp(-static_cast<double>(out[0]))),
          .log_radius = factor(1),
          .log_reach = factor(2),
          .along = factor(3),
          .log_radius_sd = sd(4),
          .log_reach_sd = sd(5),
          .along_sd = sd(6),
          .across_sd = sd(7)};
}

std::string as_text(const RockNetwork& network) {
  StoredNetwork stored;
  stored.kind = "rocks";
  stored.trained_on = network.trained_on;
  stored.prior = static_cast<double>(network.rock_prior);
  stored.centre.assign(network.mean.begin(), network.mean.end());
  stored.scale.assign(network.sd.begin(), network.sd.end());
  stored.layers = {store_layer(network.hidden, kEvidenceCount, network.units()),
                   store_layer(network.out, network.units(), kRockOutputs)};
  return network_as_text(stored, {.digits = 4});
}

RockNetwork parse_rock_network(std::string_view text, const std::string& where) {
  const StoredNetwork stored =
      parse_network(text, "rocks", where, dense_layers_of(static_cast<int>(kEvidenceCount)));
  if (stored.prior == 0) refuse_network("rocks", "its prior is missing", where);
  if (stored.centre.size() != kEvidenceCount)
    refuse_network("rocks", fmt::format("{} inputs where {} belong", stored.centre.size(), kEvidenceCount),
                   where);
  if (stored.layers.size() != 2 || stored.layers[0].outputs() > static_cast<int>(kMaxRockUnits) ||
      stored.layers[1].outputs() != static_cast<int>(kRockOutputs))
    refuse_network(
        "rocks", fmt::format("it has a layer of 1 to {} outputs and one of {}", kMaxRockUnits, kRockOutputs),
        where);
  RockNetwork network;
  network.rock_prior = static_cast<float>(stored.prior);
  network.mean = as_floats(stored.centre), network.sd = as_floats(stored.scale);
  network.hidden = load_layer(stored.layers[0]), network.out = load_layer(stored.layers[1]);
  network.trained_on = stored.trained_on;
  return network;
}

}  // namespace waymark::pipeline

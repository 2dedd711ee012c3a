// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/relief_verifier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "pipeline/vision/network_text.hpp"

namespace waymark::pipeline {
namespace {

constexpr const char* kKind = "craters_in_relief";
constexpr int kOutputs = 4;

// A network ends with the first layer of four outputs.
bool ends_network(const StoredLayer& layer) {
  return layer.outputs() == kOutputs;
}

std::string problem_with_layer(std::span<const StoredLayer> before, const StoredLayer& layer) {
  const bool first = before.empty() || ends_network(before.back());
  return dense_layers_of(kCraterFeatures)(first ? std::span<const StoredLayer>{} : before, layer);
}

}  // namespace

double log_odds(const ReliefVerifier& verifier, const CraterFeatures& features) {
  assert(!verifier.networks.empty());
  double sum = 0;
  for (const ReliefVerifier::Network& network : verifier.networks) {
    const double p = std::clamp(predict(network, features).probability, 1e-6, 1 - 1e-6);
    sum += std::log(p / (1 - p));
  }
  return sum / double(verifier.networks.size()) - std::log(verifier.prior / (1 - verifier.prior));
}

std::string as_text(const ReliefVerifier& verifier) {
  StoredNetwork stored;
  stored.kind = kKind;
  stored.trained_on = verifier.trained_on;
  stored.prior = verifier.prior;
  for (const ReliefVerifier::Network& network : verifier.networks)
    for (const CraterModel::Layer& layer : network)
      stored.layers.push_back({{layer.inputs, layer.outputs},
                               {layer.biases.begin(), layer.biases.end()},
                               {layer.weights.begin(), layer.weights.end()}});
  return network_as_text(stored, {.digits = 0});
}

ReliefVerifier parse_relief_verifier(std::string_view text, const std::string& where) {
  const StoredNetwork stored = parse_network(text, kKind, where, problem_with_layer);
  ReliefVerifier verifier;
  verifier.trained_on = stored.trained_on;
  verifier.prior = stored.prior;
  if (!(verifier.prior > 0 && verifier.prior < 1))
    refuse_network(kKind, "the line 'prior P' is missing, a fraction between 0 and 1", where);
  bool complete = true;
  for (const StoredLayer& layer : stored.layers) {
    if (complete) verifier.networks.emplace_back();
    verifier.networks.back().push_back(
        {layer.inputs(), layer.outputs(), as_floats(layer.weights), as_floats(layer.biases)});
    complete = ends_network(layer);
  }
  if (verifier.networks.empty() || !complete)
    refuse_network(kKind, "the last layer must have 4 outputs", where);
  return verifier;
}

}  // namespace waymark::pipeline

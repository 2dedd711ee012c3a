// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/dense_network.hpp"

#include <algorithm>

#include "pipeline/vision/network_text.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kBatch = 256;  // examples whose values fit in the L1 cache

}  // namespace

void evaluate(const DenseNetwork& network, std::span<const float* const> inputs, std::span<float> log_odds) {
  std::vector<float> in, out;
  for (std::size_t first = 0; first < log_odds.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, log_odds.size() - first);
    in.resize(inputs.size() * count);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (std::size_t x = 0; x < count; ++x)
        in[i * count + x] = (inputs[i][first + x] - network.centre[i]) / network.scale[i];
    for (const auto& layer : network.layers) {
      const auto width = static_cast<std::size_t>(layer.inputs);
      out.resize(layer.biases.size() * count);
      for (std::size_t o = 0; o < layer.biases.size(); ++o) {
        float* const sum = out.data() + o * count;
        std::fill_n(sum, count, layer.biases[o]);
        for (std::size_t i = 0; i < width; ++i) {
          const float weight = layer.weights[o * width + i];
          const float* const value = in.data() + i * count;
          for (std::size_t x = 0; x < count; ++x) sum[x] += weight * value[x];
        }
      }
      if (&layer != &network.layers.back())
        for (float& value : out) value = std::max(value, 0.0F);
      in.swap(out);
    }
    std::copy_n(in.begin(), count, log_odds.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

std::string as_text(const DenseNetwork& network, std::string_view kind) {
  StoredNetwork stored;
  stored.kind = kind;
  stored.trained_on = network.trained_on;
  stored.centre.assign(network.centre.begin(), network.centre.end());
  stored.scale.assign(network.scale.begin(), network.scale.end());
  for (const auto& layer : network.layers)
    stored.layers.push_back({{layer.inputs, layer.outputs},
                             {layer.biases.begin(), layer.biases.end()},
                             {layer.weights.begin(), layer.weights.end()}});
  return network_as_text(stored, {.digits = 4});
}

DenseNetwork parse_dense_network(std::string_view text, std::string_view kind, const std::string& where) {
  const StoredNetwork stored = parse_network(text, kind, where);
  DenseNetwork network;
  network.trained_on = stored.trained_on;
  network.centre = as_floats(stored.centre);
  network.scale = as_floats(stored.scale);
  const LayerCheck check = dense_layers_of(static_cast<int>(network.centre.size()));
  for (std::size_t i = 0; i < stored.layers.size(); ++i) {
    const StoredLayer& layer = stored.layers[i];
    if (const auto problem = check(std::span(stored.layers).first(i), layer); !problem.empty())
      refuse_network(kind, problem, where);
    network.layers.push_back(
        {layer.inputs(), layer.outputs(), as_floats(layer.weights), as_floats(layer.biases)});
  }
  if (network.layers.empty() || network.layers.back().outputs != 1)
    refuse_network(kind, "the last layer must have 1 output", where);
  return network;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/craters/crater_model.hpp"
#include "pipeline/vision/network_text.hpp"

namespace waymark::pipeline {
namespace {

bool is_complete(const StoredLayer& c) {
  return c.outputs() == 4 && (c.shape[0] - c.shape[3]) / c.shape[4] + 1 == 1;
}

// The input of a convolution must have the size of the previous layer's output.
std::string problem_with_convolution(std::span<const StoredLayer> before, const StoredLayer& layer) {
  const bool first = before.empty() || before.back().is_dense() || is_complete(before.back());
  int side = kWidePatchSide, channels = 1;
  if (!first) {
    const auto& shape = before.back().shape;
    side = (shape[0] - shape[3]) / shape[4] + 1, channels = before.back().outputs();
  }
  const auto& shape = layer.shape;
  if (shape[0] != side || shape[1] != channels)
    return fmt::format("a convolution of {0} x {0} x {1} follows {2} x {2} x {3}", shape[0], shape[1], side,
                       channels);
  if (shape[2] != 0 && (shape[2] != kScalarInputs || shape[3] != shape[0]))
    return fmt::format("{} facts go into a convolution as wide as its input, or none", kScalarInputs);
  if (std::ranges::find(kConvolutionOutputs, layer.outputs()) == kConvolutionOutputs.end())
    return "a convolution has 4, 8, 16 or 32 outputs";
  return "";
}

std::string problem_with(std::span<const StoredLayer> before, const StoredLayer& layer) {
  if (!layer.is_dense()) return problem_with_convolution(before, layer);
  return !before.empty() && !before.back().is_dense() ? "a dense layer follows a convolution"
                                                      : dense_layers_of(kCraterFeatures)(before, layer);
}

StoredLayer stored(const Convolution& c) {
  StoredLayer layer{
      {c.side, c.channels, c.scalars, c.kernel, c.stride, c.outputs}, {c.biases.begin(), c.biases.end()}, {}};
  const auto outputs = static_cast<std::size_t>(c.outputs);
  for (std::size_t o = 0; o < outputs; ++o)
    for (std::size_t i = o; i < c.weights.size(); i += outputs)
      layer.weights.push_back(static_cast<double>(c.weights[i]));
  return layer;
}

Convolution convolution_of(const StoredLayer& layer) {
  const auto& shape = layer.shape;
  Convolution c{shape[0], shape[1], shape[2], shape[3], shape[4], shape[5], {}, as_floats(layer.biases)};
  const auto inputs = static_cast<std::size_t>(layer.inputs()), outputs = layer.biases.size();
  c.weights.resize(inputs * outputs);
  for (std::size_t o = 0; o < outputs; ++o)
    for (std::size_t i = 0; i < inputs; ++i)
      c.weights[i * outputs + o] = static_cast<float>(layer.weights[o * inputs + i]);
  return c;
}

}  // namespace

std::string as_text(const CraterModel& model) {
  StoredNetwork network;
  network.kind = "craters";
  network.trained_on = model.trained_on;
  for (const CraterModel::Layer& layer : model.layers)
    network.layers.push_back({{layer.inputs, layer.outputs},
                              {layer.biases.begin(), layer.biases.end()},
                              {layer.weights.begin(), layer.weights.end()}});
  for (const ConvolutionNet& net : model.convolution_nets)
    for (const Convolution& convolution : net) network.layers.push_back(stored(convolution));
  return network_as_text(network, {.digits = 0});
}

CraterModel parse_crater_model(std::string_view text, const std::string& where) {
  const StoredNetwork network = parse_network(text, "craters", where, problem_with);
  CraterModel model;
  model.trained_on = network.trained_on;
  bool complete = true;
  for (const StoredLayer& layer : network.layers) {
    if (layer.is_dense()) {
      model.layers.push_back(
          {layer.inputs(), layer.outputs(), as_floats(layer.weights), as_floats(layer.biases)});
      continue;
    }
    if (complete) model.convolution_nets.emplace_back();
    model.convolution_nets.back().push_back(convolution_of(layer));
    complete = is_complete(layer);
  }
  if (model.layers.empty() || model.layers.back().outputs != 4)
    refuse_network("craters", "the last layer must have 4 outputs", where);
  if (!complete) refuse_network("craters", "the last convolution must give 4 outputs at one place", where);
  return model;
}

}  // namespace waymark::pipeline

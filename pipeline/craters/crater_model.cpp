// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_model.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace waymark::pipeline {
namespace {

// Adds weights x inputs to each output. Several outputs are computed at once for speed; each adds its
// products in the order of the inputs, so results do not depend on that.
void add_products(const CraterModel::Layer& layer, const std::vector<float>& in, std::vector<float>& out) {
  constexpr std::size_t together = 8;
  const std::size_t n = in.size();
  for (std::size_t first = 0; first < out.size(); first += together) {
    const std::size_t count = std::min(together, out.size() - first);
    std::array<const float*, together> row{};
    for (std::size_t k = 0; k < together; ++k)
      row[k] = layer.weights.data() + (first + std::min(k, count - 1)) * n;
    std::array<float, together> total{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < together; ++k) total[k] += row[k][i] * in[i];
    for (std::size_t k = 0; k < count; ++k) out[first + k] += total[k];
  }
}

CraterPrediction prediction_from(const std::vector<float>& out) {
  assert(out.size() == 4);
  return {1 / (1 + std::exp(-double(out[0]))), std::clamp(0.1 * out[1], -0.5, 0.5),
          std::clamp(0.1 * out[2], -0.5, 0.5), std::clamp(0.1 * out[3], -0.7, 0.7)};
}

}  // namespace

CraterPrediction predict(std::span<const CraterModel::Layer> layers, const CraterFeatures& features) {
  std::vector<float> in(features.begin(), features.end()), out;
  for (const CraterModel::Layer& layer : layers) {
    assert(static_cast<std::size_t>(layer.inputs) == in.size());
    out = layer.biases;
    add_products(layer, in, out);
    if (&layer != &layers.back())
      for (float& value : out) value = value > 0 ? value : 0.1F * value;
    in.swap(out);
  }
  return prediction_from(in);
}

CraterPrediction predict(const CraterModel& model, const CraterFeatures& features) {
  return predict(std::span<const CraterModel::Layer>(model.layers), features);
}

CraterPrediction predict(std::span<const ConvolutionNet> convolution_nets, const WidePatch& wide) {
  assert(!convolution_nets.empty());
  std::vector<float> mean(4);
  for (const ConvolutionNet& net : convolution_nets) {
    const std::vector<float> one = evaluate(net, wide.patch, wide.scalars);
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] += one[i] / static_cast<float>(convolution_nets.size());
  }
  return prediction_from(mean);
}

CraterCandidate apply_correction(const CraterCandidate& c, const CraterPrediction& prediction,
                                 Radians sun_angle) {
  const double u = prediction.along * c.diameter, v = prediction.across * c.diameter;
  const double cosine = std::cos(sun_angle.value), sine = std::sin(sun_angle.value);
  return {c.x + u * cosine - v * sine, c.y + u * sine + v * cosine,
          c.diameter * std::exp(prediction.log_size), c.score};
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.hpp"
#include "pipeline/vision/dense_network.hpp"

namespace waymark::pipeline {
namespace {

// State of a layer in training: values and gradients by unit, `count` examples each.
struct LayerState {
  DenseNetwork::Layer& layer;
  std::vector<float> in, out, slope;          // slope: gradient of the loss by the sums of this layer
  std::vector<float> gradient, mean, square;  // of weights, then biases: this step's, Adam's moments

  explicit LayerState(DenseNetwork::Layer& l) : layer(l) {
    gradient.assign(l.weights.size() + l.biases.size(), 0);
    mean = square = gradient;
  }
};

void forward(LayerState& l, std::size_t count, bool last) {
  const auto width = static_cast<std::size_t>(l.layer.inputs);
  l.out.assign(l.layer.biases.size() * count, 0);
  for (std::size_t o = 0; o < l.layer.biases.size(); ++o) {
    float* const sum = l.out.data() + o * count;
    std::fill_n(sum, count, l.layer.biases[o]);
    for (std::size_t i = 0; i < width; ++i) {
      const float weight = l.layer.weights[o * width + i];
      for (std::size_t x = 0; x < count; ++x) sum[x] += weight * l.in[i * count + x];
    }
  }
  if (!last)
    for (float& value : l.out) value = std::max(value, 0.0F);
}

// Stores the gradient by the inputs in `below`, if not null.
void backward(LayerState& l, std::size_t count, std::vector<float>* below) {
  const auto width = static_cast<std::size_t>(l.layer.inputs);
  if (below) below->assign(width * count, 0);
  for (std::size_t o = 0; o < l.layer.biases.size(); ++o) {
    const float* const slope = l.slope.data() + o * count;
    for (std::size_t i = 0; i < width; ++i) {
      const float* const in = l.in.data() + i * count;
      float sum = 0;
      for (std::size_t x = 0; x < count; ++x) sum += slope[x] * in[x];
      l.gradient[o * width + i] = sum;
      if (!below) continue;
      const float weight = l.layer.weights[o * width + i];
      for (std::size_t x = 0; x < count; ++x) (*below)[i * count + x] += weight * slope[x];
    }
    l.gradient[l.layer.weights.size() + o] = std::accumulate(slope, slope + count, 0.0F);
  }
}

void step(LayerState& l, double rate, int steps) {
  const double mean_correction = 1 - std::pow(0.9, steps), square_correction = 1 - std::pow(0.999, steps);
  const std::size_t weights = l.layer.weights.size();
  for (std::size_t i = 0; i < l.gradient.size(); ++i) {
    const double g = l.gradient[i];
    l.mean[i] = static_cast<float>(0.9 * l.mean[i] + 0.1 * g);
    l.square[i] = static_cast<float>(0.999 * l.square[i] + 0.001 * g * g);
    float& value = i < weights ? l.layer.weights[i] : l.layer.biases[i - weights];
    value -= static_cast<float>(rate * (l.mean[i] / mean_correction) /
                                (std::sqrt(l.square[i] / square_correction) + 1e-8));
  }
}

DenseNetwork initial_network(const NetworkExamples& examples, const NetworkTraining& training,
                             Random& random) {
  DenseNetwork network;
  const auto width = static_cast<std::size_t>(examples.inputs);
  const double count = std::max(1.0, static_cast<double>(examples.targets.size()));
  std::vector<double> sum(width), square(width);
  for (std::size_t i = 0; i < examples.values.size(); ++i) sum[i % width] += double(examples.values[i]);
  for (std::size_t i = 0; i < examples.values.size(); ++i) {
    const double off = double(examples.values[i]) - sum[i % width] / count;
    square[i % width] += off * off;
  }
  for (std::size_t i = 0; i < width; ++i) {
    network.centre.push_back(static_cast<float>(sum[i] / count));
    network.scale.push_back(static_cast<float>(std::sqrt(square[i] / count) + 1e-6));
  }
  std::vector<int> sizes = training.hidden;
  sizes.push_back(1);
  int inputs = examples.inputs;
  for (const int outputs : sizes) {
    DenseNetwork::Layer layer{.inputs = inputs, .outputs = outputs, .weights = {}, .biases = {}};
    for (int i = 0; i < inputs * outputs; ++i)
      layer.weights.push_back(static_cast<float>(random.normal(0, std::sqrt(2.0 / inputs))));
    layer.biases.resize(static_cast<std::size_t>(outputs));
    inputs = outputs;
    network.layers.push_back(std::move(layer));
  }
  return network;
}

}  // namespace

DenseNetwork train_network(const NetworkExamples& examples, const NetworkTraining& training,
                           const std::function<void(int, double)>& progress) {
  Random random(training.seed, "network training");
  DenseNetwork network = initial_network(examples, training, random);
  std::vector<LayerState> layers(network.layers.begin(), network.layers.end());
  const auto width = static_cast<std::size_t>(examples.inputs);
  std::vector<std::size_t> order(examples.targets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto batch = static_cast<std::size_t>(training.batch_size);
  const double all_steps = training.rounds * std::ceil(double(order.size()) / double(batch));
  int steps = 0;
  for (int round = 0; round < training.rounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    double loss = 0;
    for (std::size_t first = 0; first < order.size(); first += batch) {
      const std::size_t count = std::min(batch, order.size() - first);
      auto& in = layers.front().in;
      in.resize(width * count);
      for (std::size_t x = 0; x < count; ++x)
        for (std::size_t i = 0; i < width; ++i)
          in[i * count + x] =
              (examples.values[order[first + x] * width + i] - network.centre[i]) / network.scale[i];
      for (std::size_t l = 0; l < layers.size(); ++l) {
        forward(layers[l], count, l + 1 == layers.size());
        if (l + 1 < layers.size()) layers[l + 1].in = layers[l].out;
      }
      auto& slope = layers.back().slope;
      slope.resize(count);
      for (std::size_t x = 0; x < count; ++x) {
        const double z = double(layers.back().out[x]), wanted = double(examples.targets[order[first + x]]);
        loss += std::max(z, 0.0) - z * wanted + std::log1p(std::exp(-std::abs(z)));
        slope[x] = static_cast<float>((1 / (1 + std::exp(-z)) - wanted) / double(count));
      }
      for (std::size_t l = layers.size(); l-- > 0;) {
        backward(layers[l], count, l > 0 ? &layers[l - 1].slope : nullptr);
        if (l == 0) break;
        for (std::size_t i = 0; i < layers[l - 1].slope.size(); ++i)
          if (!(layers[l - 1].out[i] > 0)) layers[l - 1].slope[i] = 0;
      }
      const double rate = training.rate * 0.5 * (1 + std::cos(std::numbers::pi * steps / all_steps));
      ++steps;
      for (LayerState& l : layers) step(l, rate, steps);
    }
    if (progress) progress(round, loss / std::max(1.0, double(order.size())));
  }
  return network;
}

}  // namespace waymark::pipeline

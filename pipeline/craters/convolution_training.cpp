// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/convolution_training.hpp"

#include <cmath>

namespace waymark::pipeline {
namespace {

// Computes the gradient by the inputs from that by the sums and adds that by the weights. Layout as in
// convolve.
template <int kOutputs>
void accumulate_gradients(const Convolution& layer, const float* in, const float* scalars, const float* error,
                          float* slope, float* back) {
  const int places = layer.out_side(), row = layer.kernel * layer.channels;
  float* bias = slope + layer.weights.size();
  for (int y = 0; y < places; ++y)
    for (int x = 0; x < places; ++x, error += kOutputs) {
      for (int o = 0; o < kOutputs; ++o) bias[o] += error[o];
      float* into = slope;
      const float* weight = layer.weights.data();
      const auto add = [&](const float* value, float* by_value, int count) {
        for (int i = 0; i < count; ++i, into += kOutputs, weight += kOutputs) {
          std::array<float, 4> parts{};
          for (int o = 0; o < kOutputs; o += 4)
            for (int k = 0; k < 4; ++k) {
              into[o + k] += value[i] * error[o + k];
              parts[static_cast<std::size_t>(k)] += weight[o + k] * error[o + k];
            }
          if (by_value) by_value[i] += (parts[0] + parts[1]) + (parts[2] + parts[3]);
        }
      };
      for (int j = 0; j < layer.kernel; ++j) {
        const std::ptrdiff_t at =
            std::ptrdiff_t{(y * layer.stride + j) * layer.side + x * layer.stride} * layer.channels;
        add(in + at, back + at, row);
      }
      add(scalars, nullptr, layer.scalars);
    }
}

}  // namespace

ConvolutionTrainer::ConvolutionTrainer(ConvolutionNet net, Random& random) : net_(std::move(net)) {
  for (Convolution& layer : net_) {
    const double quiet = &layer == &net_.back() ? 0.3 : 1;  // small initial outputs
    const double deviation = quiet * std::sqrt(2.0 / layer.inputs());
    layer.weights.resize(static_cast<std::size_t>(layer.inputs() * layer.outputs));
    for (float& weight : layer.weights) weight = static_cast<float>(random.normal(0, deviation));
    layer.biases.assign(static_cast<std::size_t>(layer.outputs), 0.0F);
    const std::vector<float> none(layer.weights.size() + layer.biases.size(), 0.0F);
    memory_.push_back({none, none, none});
  }
  values_.resize(net_.size() + 1);
}

std::span<const float> ConvolutionTrainer::forward(std::span<const float> image,
                                                   std::span<const float> scalars) {
  values_[0].assign(image.begin(), image.end());
  scalars_.assign(scalars.begin(), scalars.end());
  for (std::size_t i = 0; i < net_.size(); ++i)
    convolve(net_[i], values_[i], scalars_, i + 1 == net_.size(), values_[i + 1]);
  return values_.back();
}

void ConvolutionTrainer::backward(std::span<const float> slopes) {
  std::vector<float> error(slopes.begin(), slopes.end()), back;
  for (std::size_t i = net_.size(); i-- > 0;) {
    const Convolution& layer = net_[i];
    if (i + 1 < net_.size())
      for (std::size_t k = 0; k < error.size(); ++k)
        if (values_[i + 1][k] < 0) error[k] *= 0.1F;
    back.assign(values_[i].size(), 0.0F);
    const auto go = [&](auto slopes_by) {
      slopes_by(layer, values_[i].data(), scalars_.data(), error.data(), memory_[i].slope.data(),
                back.data());
    };
    switch (layer.outputs) {
      case 4:
        go(accumulate_gradients<4>);
        break;
      case 8:
        go(accumulate_gradients<8>);
        break;
      case 16:
        go(accumulate_gradients<16>);
        break;
      default:
        go(accumulate_gradients<32>);
        break;
    }
    error.swap(back);
  }
}

void ConvolutionTrainer::step(double rate, double decay, double examples) {
  ++steps_;
  const double correct1 = 1 - std::pow(0.9, steps_), correct2 = 1 - std::pow(0.999, steps_);
  for (std::size_t l = 0; l < net_.size(); ++l) {
    Convolution& layer = net_[l];
    Memory& memory = memory_[l];
    for (std::size_t i = 0; i < memory.slope.size(); ++i) {
      const double g = memory.slope[i] / examples;
      memory.mean[i] = static_cast<float>(0.9 * memory.mean[i] + 0.1 * g);
      memory.square[i] = static_cast<float>(0.999 * memory.square[i] + 0.001 * g * g);
      const bool weight = i < layer.weights.size();
      float& value = weight ? layer.weights[i] : layer.biases[i - layer.weights.size()];
      const double move = memory.mean[i] / correct1 / (std::sqrt(memory.square[i] / correct2) + 1e-8);
      value -= static_cast<float>(rate * (move + (weight ? decay * value : 0)));
      memory.slope[i] = 0;
    }
  }
}

}  // namespace waymark::pipeline

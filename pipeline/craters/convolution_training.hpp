// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "pipeline/craters/convolution_net.hpp"
namespace waymark::pipeline {

/// Accumulates the gradient of a loss by the weights of a network and updates them with Adam (Kingma & Ba
/// 2015).
class ConvolutionTrainer {
 public:
  /// Initialises the weights (He et al. 2015).
  ConvolutionTrainer(ConvolutionNet net, Random& random);

  std::span<const float> forward(std::span<const float> image, std::span<const float> scalars);
  /// Adds the gradient by the weights; `slopes` is the gradient of the loss by the outputs of the last
  /// forward().
  void backward(std::span<const float> slopes);
  /// Updates the weights by the mean gradient of `examples`, with weight decay (Loshchilov & Hutter 2019).
  void step(double rate, double decay, double examples);
  const ConvolutionNet& net() const { return net_; }

 private:
  struct Memory {
    std::vector<float> slope, mean, square;  // weights, then biases
  };
  ConvolutionNet net_;
  std::vector<Memory> memory_;
  std::vector<std::vector<float>> values_;  // inputs of each layer, then the outputs
  std::vector<float> scalars_;
  int steps_ = 0;
};

}  // namespace waymark::pipeline

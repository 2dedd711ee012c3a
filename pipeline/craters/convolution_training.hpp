// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "pipeline/craters/convolution_net.hpp"
namespace waymark {

/// Slopes of a loss by the weights of a network, and Adam's memory (Kingma & Ba 2015) of them.
class ConvolutionLearner {
 public:
  /// First weights by He et al. 2015.
  ConvolutionLearner(ConvolutionNet net, Random& random);

  std::span<const float> forward(std::span<const float> image, std::span<const float> facts);
  /// `slopes` of the loss by the answer of the last forward; adds to those by the weights.
  void backward(std::span<const float> slopes);
  /// Moves the weights against the mean slope of `examples`, with weight decay (Loshchilov & Hutter 2019).
  void step(double rate, double decay, double examples);
  const ConvolutionNet& net() const { return net_; }

 private:
  struct Memory {
    std::vector<float> slope, mean, square;  // weights, then biases
  };
  ConvolutionNet net_;
  std::vector<Memory> memory_;
  std::vector<std::vector<float>> values_;  // what goes into each layer, and the answer
  std::vector<float> facts_;
  int steps_ = 0;
};

}  // namespace waymark

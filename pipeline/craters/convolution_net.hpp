// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>
namespace waymark::pipeline {

/// Layer of a convolutional network. The input is a square of `side` samples with `channels` each; the
/// window covers `kernel` samples and moves by `stride`. `scalars` scalar inputs, the same at every position,
/// are appended to the window; only for a layer whose window is the whole square.
struct Convolution {
  int side = 0, channels = 0, scalars = 0;
  int kernel = 0, stride = 1, outputs = 0;
  std::vector<float> weights;  ///< by row, column and channel of the window, then scalars; outputs innermost
  std::vector<float> biases;

  int inputs() const { return kernel * kernel * channels + scalars; }
  int out_side() const { return (side - kernel) / stride + 1; }
};

/// Numbers of outputs that a layer may have; sums are held in registers.
inline constexpr std::array<int, 4> kConvolutionOutputs{4, 8, 16, 32};

/// Small convolutional network (LeCun et al. 1998) with leaky rectifiers (leak 0.1) on all layers but the
/// last. Strides replace pooling (Springenberg et al. 2015).
using ConvolutionNet = std::vector<Convolution>;

/// Computes the outputs of one layer by row, column and output; rectified unless it is the `last`.
/// O(weights x positions).
void convolve(const Convolution& layer, std::span<const float> in, std::span<const float> scalars, bool last,
              std::vector<float>& out);

/// Returns the outputs of the network for a square image.
std::vector<float> evaluate(const ConvolutionNet& net, std::span<const float> image,
                            std::span<const float> scalars);

}  // namespace waymark::pipeline

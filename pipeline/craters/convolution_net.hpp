// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>
namespace waymark {

/// One layer: a square of `side` samples of `channels` each is seen through a window of `kernel` samples that
/// moves by `stride`. `facts` more numbers, the same at every place, go in beside the window: for the layer
/// whose window is the whole square.
struct Convolution {
  int side = 0, channels = 0, facts = 0;
  int kernel = 0, stride = 1, outputs = 0;
  std::vector<float> weights;  ///< by row, column and channel of the window, then facts; outputs innermost
  std::vector<float> biases;

  int inputs() const { return kernel * kernel * channels + facts; }
  int out_side() const { return (side - kernel) / stride + 1; }
};

/// Numbers of outputs a layer may have: sums of as many are held in registers.
inline constexpr std::array<int, 4> kConvolutionOutputs{4, 8, 16, 32};

/// A small convolutional network (LeCun et al. 1998), layers of rectified sums (leak 0.1) but for the last.
/// Strides stand in place of pooling (Springenberg et al. 2015).
using ConvolutionNet = std::vector<Convolution>;

/// Sums of one layer, rectified unless it is the `last`. Rows, columns, outputs. O(weights x places).
void convolve(const Convolution& layer, std::span<const float> in, std::span<const float> facts, bool last,
              std::vector<float>& out);

/// What the network says of a square image.
std::vector<float> answer(const ConvolutionNet& net, std::span<const float> image,
                          std::span<const float> facts);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/convolution_net.hpp"

#include <cassert>
#include <cstddef>

namespace waymark {
namespace {

// The number of outputs is known to the compiler, which then adds four at a time.
template <int kOutputs>
void sums(const Convolution& layer, const float* in, const float* facts, float* out) {
  const int places = layer.out_side(), row = layer.kernel * layer.channels;
  for (int y = 0; y < places; ++y)
    for (int x = 0; x < places; ++x) {
      std::array<float, kOutputs> total;
      for (int o = 0; o < kOutputs; ++o)
        total[static_cast<std::size_t>(o)] = layer.biases[static_cast<std::size_t>(o)];
      const float* weight = layer.weights.data();
      const auto add = [&](const float* value, int count) {
        for (int i = 0; i < count; ++i, weight += kOutputs)
          for (int o = 0; o < kOutputs; ++o) total[static_cast<std::size_t>(o)] += value[i] * weight[o];
      };
      for (int j = 0; j < layer.kernel; ++j)
        add(in + ((y * layer.stride + j) * layer.side + x * layer.stride) * layer.channels, row);
      add(facts, layer.facts);
      for (const float sum : total) *out++ = sum;
    }
}

}  // namespace

void convolve(const Convolution& layer, std::span<const float> in, std::span<const float> facts, bool last,
              std::vector<float>& out) {
  assert(in.size() == static_cast<std::size_t>(layer.side * layer.side * layer.channels));
  assert(layer.facts == 0 || facts.size() == static_cast<std::size_t>(layer.facts));
  out.resize(static_cast<std::size_t>(layer.out_side() * layer.out_side() * layer.outputs));
  switch (layer.outputs) {
    case 4:
      sums<4>(layer, in.data(), facts.data(), out.data());
      break;
    case 8:
      sums<8>(layer, in.data(), facts.data(), out.data());
      break;
    case 16:
      sums<16>(layer, in.data(), facts.data(), out.data());
      break;
    case 32:
      sums<32>(layer, in.data(), facts.data(), out.data());
      break;
    default:
      assert(false);
  }
  if (!last)
    for (float& value : out) value = value > 0 ? value : 0.1F * value;
}

std::vector<float> answer(const ConvolutionNet& net, std::span<const float> image,
                          std::span<const float> facts) {
  std::vector<float> in(image.begin(), image.end()), out;
  for (const Convolution& layer : net) {
    convolve(layer, in, facts, &layer == &net.back(), out);
    in.swap(out);
  }
  return in;
}

}  // namespace waymark

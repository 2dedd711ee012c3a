// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/convolution_net.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace waymark::pipeline {
namespace {

constexpr int kLanes = 8;
using Lanes [[gnu::vector_size(sizeof(float) * kLanes)]] = float;

// Computes kVectors x kLanes outputs at kTogether positions of a row at once: each weight is read once, sums
// are independent and stay in registers, since all indices are known at compile time. Each sum adds its
// products in the order of the inputs. Negative sums are multiplied by `leak`.
template <int kVectors, int kTogether>
[[gnu::always_inline]] inline void sums(const Convolution& layer, const float* in, const float* scalars,
                                        float leak, float* out) {
  const int places = layer.out_side(), row = layer.kernel * layer.channels;
  const std::ptrdiff_t apart = std::ptrdiff_t{layer.stride} * layer.channels;
  const auto each = []<std::size_t... kIndex>(std::index_sequence<kIndex...>, const auto& act)
      __attribute__((always_inline)) {
    (act(std::integral_constant<std::size_t, kIndex>{}), ...);
  };
  constexpr std::make_index_sequence<std::size_t{kVectors} * kTogether> all;
  for (int y = 0; y < places; ++y)
    for (int x = 0; x < places; x += kTogether, out += kTogether * kVectors * kLanes) {
      Lanes total[kVectors * kTogether];
      each(
          all, [&](auto i) __attribute__((always_inline)) {
            std::memcpy(&total[i], layer.biases.data() + i % kVectors * kLanes, sizeof(Lanes));
          });
      const float* weight = layer.weights.data();
      const auto add = [&](const float* value, int count, std::ptrdiff_t step)
          __attribute__((always_inline)) {
        for (int n = 0; n < count; ++n, ++value, weight += kVectors * kLanes)
          each(
              all, [&](auto i) __attribute__((always_inline)) {
                Lanes by;
                std::memcpy(&by, weight + i % kVectors * kLanes, sizeof by);
                total[i] += value[std::ptrdiff_t{i / kVectors} * step] * by;
              });
      };
      for (int j = 0; j < layer.kernel; ++j)
        add(in + ((y * layer.stride + j) * layer.side + x * layer.stride) * layer.channels, row, apart);
      add(scalars, layer.scalars, 0);
      each(
          all, [&](auto i) __attribute__((always_inline)) {
            const Lanes result = total[i] > 0 ? total[i] : leak * total[i];
            std::memcpy(out + i * kLanes, &result, sizeof result);
          });
    }
}

void four_sums(const Convolution& layer, const float* in, const float* scalars, float leak, float* out) {
  const int places = layer.out_side(), row = layer.kernel * layer.channels;
  for (int y = 0; y < places; ++y)
    for (int x = 0; x < places; ++x) {
      std::array<float, 4> total{};
      std::copy_n(layer.biases.begin(), 4, total.begin());
      const float* weight = layer.weights.data();
      const auto add = [&](const float* value, int count) {
        for (int i = 0; i < count; ++i, weight += 4)
          for (std::size_t o = 0; o < 4; ++o) total[o] += value[i] * weight[o];
      };
      for (int j = 0; j < layer.kernel; ++j)
        add(in + ((y * layer.stride + j) * layer.side + x * layer.stride) * layer.channels, row);
      add(scalars, layer.scalars);
      for (const float sum : total) *out++ = sum > 0 ? sum : leak * sum;
    }
}

[[gnu::always_inline]] inline void all_sums(const Convolution& layer, const float* in, const float* scalars,
                                            float leak, float* out) {
  const int places = layer.out_side();
  switch (layer.outputs) {
    case 4:
      return four_sums(layer, in, scalars, leak, out);
    case 8:
      return places % 5 == 0 ? sums<1, 5>(layer, in, scalars, leak, out)
                             : sums<1, 1>(layer, in, scalars, leak, out);
    case 16:
      return places % 4 == 0 ? sums<2, 4>(layer, in, scalars, leak, out)
                             : sums<2, 1>(layer, in, scalars, leak, out);
    case 32:
      return places % 2 == 0 ? sums<4, 2>(layer, in, scalars, leak, out)
                             : sums<4, 1>(layer, in, scalars, leak, out);
    default:
      assert(false);
  }
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void sums_avx2(const Convolution& layer, const float* in, const float* scalars,
                                       float leak, float* out) {
  all_sums(layer, in, scalars, leak, out);
}
#endif

void dispatch_sums(const Convolution& layer, const float* in, const float* scalars, float leak, float* out) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return sums_avx2(layer, in, scalars, leak, out);
#endif
  all_sums(layer, in, scalars, leak, out);
}

}  // namespace

void convolve(const Convolution& layer, std::span<const float> in, std::span<const float> scalars, bool last,
              std::vector<float>& out) {
  assert(in.size() == static_cast<std::size_t>(layer.side * layer.side * layer.channels));
  assert(layer.scalars == 0 || scalars.size() == static_cast<std::size_t>(layer.scalars));
  out.resize(static_cast<std::size_t>(layer.out_side() * layer.out_side() * layer.outputs));
  dispatch_sums(layer, in.data(), scalars.data(), last ? 1.0F : 0.1F, out.data());
}

std::vector<float> evaluate(const ConvolutionNet& net, std::span<const float> image,
                            std::span<const float> scalars) {
  std::vector<float> in(image.begin(), image.end()), out;
  for (const Convolution& layer : net) {
    convolve(layer, in, scalars, &layer == &net.back(), out);
    in.swap(out);
  }
  return in;
}

}  // namespace waymark::pipeline

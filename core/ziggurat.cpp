// SPDX-License-Identifier: Apache-2.0
#include "core/ziggurat.hpp"

namespace waymark::inline core {
namespace {

// For 128 layers (Doornik 2005): start of the tail, and area of each layer.
constexpr double kTail = 3.442619855899, kArea = 9.91256303526217e-3;

double curve(double x) {
  return std::exp(-x * x / 2);
}

}  // namespace

const Ziggurat& Ziggurat::instance() {
  static const Ziggurat ziggurat;
  return ziggurat;
}

Ziggurat::Ziggurat() {
  edge_[0] = kArea / curve(kTail);  // as wide as if the tail were part of the lowest layer
  edge_[1] = kTail;
  for (std::size_t i = 2; i < kLayers; ++i)
    edge_[i] = std::sqrt(-2 * std::log(kArea / edge_[i - 1] + curve(edge_[i - 1])));
  edge_[kLayers] = 0;
  for (std::size_t i = 0; i < kLayers; ++i) inner_[i] = edge_[i + 1] / edge_[i];
}

double Ziggurat::sample_edge(Random& random, std::size_t layer, double u) const {
  if (layer == 0) {  // the tail (Marsaglia 1964)
    for (;;) {
      const double x = -std::log(1 - random.uniform()) / kTail, y = -std::log(1 - random.uniform());
      if (2 * y > x * x) return u < 0 ? -kTail - x : kTail + x;
    }
  }
  const double x = u * edge_[layer], low = curve(edge_[layer]), high = curve(edge_[layer + 1]);
  return low + random.uniform() * (high - low) < curve(x) ? x : (*this)(random);
}

}  // namespace waymark::inline core

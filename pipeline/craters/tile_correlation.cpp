// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/tile_correlation.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace waymark::pipeline {
namespace {

constexpr int kLanes = 8;
using Lanes [[gnu::vector_size(sizeof(float) * kLanes)]] = float;
using Wide [[gnu::vector_size(sizeof(double) * kLanes)]] = double;

[[gnu::always_inline]] inline void normalise_body(std::span<float> responses, std::span<const float> others,
                                                  const TileSums& sums, int half, int margin, double floor) {
  const int side = 2 * half + 1, last = kTileSide - margin;
  const double each = 1.0 / (double(side) * side);
  std::array<float, kTileSide> row{};  // the last eight of a row may overlap the previous ones
  for (int y = margin; y < last; ++y) {
    const std::ptrdiff_t top = std::ptrdiff_t{y - half} * TileSums::kSide - half,
                         low = top + std::ptrdiff_t{side} * TileSums::kSide;
    float* const at = responses.data() + std::ptrdiff_t{y} * kTileSide;
    const float* const other = others.empty() ? at : others.data() + std::ptrdiff_t{y} * kTileSide;
    const auto eight = [&](int x) __attribute__((always_inline)) {
      Wide a, b, c, d;
      const auto total = [&](const std::vector<double>& all, Wide& sum) __attribute__((always_inline)) {
        std::memcpy(&a, all.data() + low + x + side, sizeof a),
            std::memcpy(&b, all.data() + top + x + side, sizeof b);
        std::memcpy(&c, all.data() + low + x, sizeof c), std::memcpy(&d, all.data() + top + x, sizeof d);
        sum = a - b - c + d;
      };
      Wide value, square;
      total(sums.values, value), total(sums.squares, square);
      const Wide spread = square - value * value * each;
      const Wide room = (spread > 0 ? spread : Wide{}) + floor;
      Lanes response, also;
      std::memcpy(&response, at + x, sizeof response), std::memcpy(&also, other + x, sizeof also);
      response = response > also ? response : also;
      const Lanes result =
          response * (response > 0 ? response : -response) / __builtin_convertvector(room, Lanes);
      std::memcpy(row.data() + x, &result, sizeof result);
    };
    for (int x = margin; x + kLanes <= last; x += kLanes) eight(x);
    eight(last - kLanes);
    std::copy(row.begin() + margin, row.begin() + last, at + margin);
  }
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void normalise_avx2(std::span<float> responses, std::span<const float> others,
                                            const TileSums& sums, int half, int margin, double floor) {
  normalise_body(responses, others, sums, half, margin, floor);
}
#endif

}  // namespace

TileSums::TileSums(std::span<const float> tile)
    : values(std::size_t{kSide} * kSide), squares(std::size_t{kSide} * kSide) {
  assert(tile.size() == ComplexTile::kCells);
  for (int y = 0; y < kTileSide; ++y) {
    double value = 0, square = 0;
    for (int x = 0; x < kTileSide; ++x) {
      const double v = tile[static_cast<std::size_t>(y * kTileSide + x)];
      value += v, square += v * v;
      const auto above = static_cast<std::size_t>(y * kSide + x + 1), here = above + kSide;
      values[here] = values[above] + value, squares[here] = squares[above] + square;
    }
  }
}

void take_maximum(std::span<float> values, std::span<const float> others) {
  assert(values.size() == others.size() && values.size() % kLanes == 0);
  for (std::size_t i = 0; i < values.size(); i += kLanes) {
    Lanes a, b;
    std::memcpy(&a, values.data() + i, sizeof a), std::memcpy(&b, others.data() + i, sizeof b);
    a = a > b ? a : b;
    std::memcpy(values.data() + i, &a, sizeof a);
  }
}

void normalise(std::span<float> responses, std::span<const float> others, const TileSums& sums, int half,
               int margin, double floor) {
  assert(margin > half && kTileSide - 2 * margin >= kLanes && responses.size() == ComplexTile::kCells);
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return normalise_avx2(responses, others, sums, half, margin, floor);
#endif
  normalise_body(responses, others, sums, half, margin, floor);
}

}  // namespace waymark::pipeline

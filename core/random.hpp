// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
namespace waymark::inline core {

/// Scrambles the bits of a number (splitmix64, Steele, Lea & Flood 2014); neighbours become uncorrelated.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Derives the seed of an independent stream for one purpose ("rocks", "noise of descent_0042"). Draws from
/// one stream do not shift the others. FNV-1a of the name, combined with the seed.
constexpr std::uint64_t named_seed(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return mix_bits(mix_bits(seed) ^ hash);
}

/// Generator of random numbers that do not depend on compiler, library and thread count: xoshiro256++
/// (Blackman & Vigna 2019) and distributions implemented here. Not for cryptography.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) {
    for (auto& word : state_) word = seed = mix_bits(seed);
  }
  constexpr Random(std::uint64_t seed, std::string_view name) : Random(named_seed(seed, name)) {}

  constexpr std::uint64_t bits() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// Draws from [0, 1) with 53 bits.
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  constexpr double uniform(double from, double to) { return from + (to - from) * uniform(); }
  /// Draws uniformly on a logarithmic scale; 0 < from <= to.
  double log_uniform(double from, double to) { return from * std::pow(to / from, uniform()); }
  /// Draws from 0, ..., count - 1; count >= 1. The bias is less than count / 2^53.
  constexpr std::uint64_t uniform_index(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }
  constexpr bool bernoulli(double probability) { return uniform() < probability; }
  /// Draws from N(0, 1) (Box & Muller 1958). The second value is discarded, so no state is needed.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  double normal(double mean, double sd) { return mean + sd * normal(); }
  /// Draws from the Poisson distribution; a rounded normal approximation for `mean` > 50.
  std::uint64_t poisson(double mean) {
    if (!(mean > 0)) return 0;
    if (mean > 50)
      return static_cast<std::uint64_t>(std::max(0.0, std::round(normal(mean, std::sqrt(mean)))));
    std::uint64_t count = 0;
    for (double left = std::exp(-mean), product = uniform(); product > left; product *= uniform()) ++count;
    return count;
  }

 private:
  std::uint64_t state_[4] = {};
};

}  // namespace waymark::inline core

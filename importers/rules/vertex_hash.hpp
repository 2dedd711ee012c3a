// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <bit>
#include <cstdint>
namespace waymark::importers {

/// Mixes the bits of a number (splitmix64, Steele et al. 2014).
inline std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Returns the hash of a vertex, by the bits of its x and y.
inline std::uint64_t hash_of(const Eigen::Vector3d& v) {
  return mix_bits(mix_bits(std::bit_cast<std::uint64_t>(v.x() + 0.0)) +  // -0 becomes 0
                  std::bit_cast<std::uint64_t>(v.y() + 0.0));
}

}  // namespace waymark::importers

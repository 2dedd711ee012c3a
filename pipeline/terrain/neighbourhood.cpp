// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/neighbourhood.hpp"

#include <algorithm>
#include <cstdlib>

namespace waymark::pipeline {
namespace {

bool touch(int a, int b) {
  const NeighbourStep p = kRing[static_cast<std::size_t>(a)], q = kRing[static_cast<std::size_t>(b)];
  return std::abs(p.column - q.column) <= 1 && std::abs(p.row - q.row) <= 1;
}

std::uint8_t flood_part(int start, std::uint8_t mask) {
  unsigned part = 1u << start;
  for (bool grown = true; grown;) {
    grown = false;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        if ((part >> a & 1) && (mask >> b & 1) && !(part >> b & 1) && touch(a, b)) {
          part |= 1u << b;
          grown = true;
        }
  }
  return static_cast<std::uint8_t>(part);
}

std::array<std::uint8_t, 256> tabulate_parts() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned left = mask, chosen = 0;
    for (int i = 0; i < 8; ++i) {
      if (!(left >> i & 1)) continue;
      chosen |= 1u << i;
      left &= ~static_cast<unsigned>(flood_part(i, static_cast<std::uint8_t>(mask)));
    }
    table[mask] = static_cast<std::uint8_t>(chosen);
  }
  return table;
}

}  // namespace

std::uint8_t connected_parts(std::uint8_t mask) {
  static const std::array<std::uint8_t, 256> table = tabulate_parts();
  return table[mask];
}

void higher_neighbours(const double* north, const double* here, const double* south,
                       std::span<std::uint8_t> masks) {
  const auto n = static_cast<std::ptrdiff_t>(masks.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double z = here[i];
    const int mask = (north[i] >= z) | (north[i + 1] >= z) << 1 | (here[i + 1] > z) << 2 |
                     (south[i + 1] > z) << 3 | (south[i] > z) << 4 | (south[i - 1] > z) << 5 |
                     (here[i - 1] >= z) << 6 | (north[i - 1] >= z) << 7;
    masks[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(mask);
  }
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>

#include "core/random.hpp"
#include "geo/image_source.hpp"
namespace waymark::test {

/// Returns bright leaves of 2 to 6 px in all directions above dark gaps: spots that no light has ordered.
inline Pixels foliage(std::uint64_t seed, std::int64_t side = 400) {
  Random random(seed, "foliage");
  Pixels image(side, side, 20);
  const auto leaves = static_cast<int>(side * side / 9);
  for (int k = 0; k < leaves; ++k) {
    const double x = random.uniform(0, static_cast<double>(side)),
                 y = random.uniform(0, static_cast<double>(side));
    const double half = random.uniform(1, 3), narrow = random.uniform(0.35, 0.7),
                 turn = random.uniform(0, 3.14159);
    const auto value = static_cast<float>(random.uniform(30, 200));
    for (auto v = std::max<std::int64_t>(0, std::lround(y - half));
         v <= std::min(side - 1, std::lround(y + half)); ++v)
      for (auto u = std::max<std::int64_t>(0, std::lround(x - half));
           u <= std::min(side - 1, std::lround(x + half)); ++u) {
        const double dx = static_cast<double>(u) - x, dy = static_cast<double>(v) - y;
        const double a = dx * std::cos(turn) + dy * std::sin(turn),
                     b = dy * std::cos(turn) - dx * std::sin(turn);
        if (std::hypot(a, b / narrow) <= half) image(u, v) = value;
      }
  }
  for (float& value : image.cells()) value += static_cast<float>(std::round(random.normal() * 2));
  return image;
}

}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rough_forest.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
namespace waymark::workflows {

RoughForest rough_forest(std::uint64_t seed, ForestType type) {
  Random random(seed, "rough forest");
  const bool mixed = type == ForestType::mixed;
  const double cell = random.bernoulli(0.5) ? 0.5 : 1.0, side = 100;
  const auto cells = static_cast<std::int64_t>(side / cell);
  const double density = random.log_uniform(100, 900) / 1e4, tallest = random.uniform(12, 35);
  const double rough = random.log_uniform(0.05, 1.2), leaders = random.log_uniform(0.3, 4);
  Grid<float> heights(cells, cells, 0);
  Grid<std::int32_t> owner(cells, cells, -1);
  const int trees = static_cast<int>(density * side * side);
  for (int t = 0; t < trees; ++t) {
    const bool conifer = type == ForestType::conifer || (mixed && random.bernoulli(0.5));
    const bool under = random.bernoulli(0.25);
    const double h = tallest * (under ? random.uniform(0.3, 0.7) : random.uniform(0.6, 1));
    const double radius = (conifer ? 0.6 + 0.075 * h : 1.0 + 0.13 * h) * random.uniform(0.7, 1.3);
    const double power = conifer ? random.uniform(1, 1.6) : random.uniform(1.8, 3);
    const double length = h * (conifer ? random.uniform(0.5, 0.8) : random.uniform(0.3, 0.6));
    const double x = random.uniform(0, side), y = random.uniform(0, side);
    struct Leader {
      double x, y, lower, width;
    };
    std::vector<Leader> tops;
    const double mean = (conifer ? 0.15 : 1) * leaders;
    for (int k = 0; k < 8; ++k)
      if (random.bernoulli(mean / 8)) {
        const double away = radius * std::sqrt(random.uniform(0.05, 0.7)), at = random.uniform(0, 6.28);
        tops.push_back({x + away * std::cos(at), y + away * std::sin(at), random.uniform(-0.02, 0.1) * h,
                        radius * random.uniform(0.25, 0.5)});
      }
    const auto from = [&](double v) {
      return std::max<std::int64_t>(0, static_cast<std::int64_t>((v - 1.3 * radius) / cell));
    };
    const auto to = [&](double v) {
      return std::min(cells - 1, static_cast<std::int64_t>((v + 1.3 * radius) / cell) + 1);
    };
    for (std::int64_t r = from(y); r <= to(y); ++r)
      for (std::int64_t c = from(x); c <= to(x); ++c) {
        const double px = (static_cast<double>(c) + 0.5) * cell, py = (static_cast<double>(r) + 0.5) * cell;
        const double away = std::hypot(px - x, py - y) / radius;
        if (away > 1.15) continue;
        double z = away < 1 ? h - length * std::pow(away, power) : 0;
        for (const Leader& one : tops) {
          const double off = std::hypot(px - one.x, py - one.y) / one.width;
          if (off < 1) z = std::max(z, h - one.lower - 0.5 * length * off * off);
        }
        if (z > static_cast<double>(heights(c, r))) heights(c, r) = static_cast<float>(z), owner(c, r) = t;
      }
  }
  const std::int64_t coarse = cells / 2;
  Grid<float> branches(coarse + 1, coarse + 1, 0);
  for (float& v : branches.cells()) v = static_cast<float>(rough * random.normal());
  for (std::int64_t r = 0; r < cells; ++r)
    for (std::int64_t c = 0; c < cells; ++c) {
      float& z = heights(c, r);
      if (owner(c, r) < 0) continue;
      z += branches(c / 2, r / 2) + static_cast<float>(0.5 * rough * random.normal());
      if (random.bernoulli(0.01)) z *= 0.4F;  // a pulse that went through
      z = std::max(0.0F, z);
    }
  return {SyntheticCanopy(std::move(heights), cell), std::move(owner)};
}

}  // namespace waymark::workflows

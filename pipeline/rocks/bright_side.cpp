// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/bright_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::pipeline {

BrightSide bright_side(const ShadowMap& map, const SpotDisc& spot) {
  const double half = std::sqrt(std::max(1.0, spot.area) / std::numbers::pi), reach = 2 * half + 1.5;
  double mx = 0, my = 0, bright = 0;
  for (auto y = static_cast<std::int64_t>(std::ceil(spot.y - reach));
       static_cast<double>(y) <= spot.y + reach; ++y)
    for (auto x = static_cast<std::int64_t>(std::ceil(spot.x - reach));
         static_cast<double>(x) <= spot.x + reach; ++x) {
      if (!map.alpha.contains(x, y) || map.alpha(x, y) >= 0) continue;
      const double dx = static_cast<double>(x) - spot.x, dy = static_cast<double>(y) - spot.y;
      const double distance = std::hypot(dx, dy);
      if (distance > reach || distance < 0.5) continue;
      const double light = std::clamp(-static_cast<double>(map.alpha(x, y)), 0.0, std::max(0.0, spot.peak));
      mx += light * dx / distance;
      my += light * dy / distance;
      bright += light;
    }
  if (!(bright > 0)) return {};
  const double moment = std::hypot(mx, my), one_sided = moment / bright;
  return {std::atan2(my, mx),
          one_sided * one_sided * std::min(1.0, moment / (spot.peak * std::max(1.0, half)))};
}

}  // namespace waymark::pipeline

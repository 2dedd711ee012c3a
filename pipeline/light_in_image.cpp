// SPDX-License-Identifier: Apache-2.0
#include "pipeline/light_in_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/craters/find_craters.hpp"

namespace waymark::pipeline {

std::optional<SunAngle> crater_sun_angle(const Pixels& image) {
  constexpr std::int64_t kSide = 1024;   // a second of work
  constexpr double kSystematic = 0.035;  // radians, found on 14 synthetic scenes
  const std::int64_t columns = std::min(kSide, image.columns()), rows = std::min(kSide, image.rows());
  const std::int64_t x0 = (image.columns() - columns) / 2, y0 = (image.rows() - rows) / 2;
  Pixels middle(columns, rows);
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x) middle(x, y) = image(x0 + x, y0 + y);
  const auto seen = estimate_crater_sun_angle(middle);
  if (!seen || !seen->sure) return std::nullopt;
  const double of_mean = seen->sd.value / std::sqrt(std::max(1, seen->craters));
  return SunAngle{seen->angle, {std::hypot(of_mean, kSystematic)}, seen->craters};
}

std::string unusual_ground_warning(const LightCoherence& seen) {
  return fmt::format(
      "{:.0f} % of {} supposed rocks have their bright side along the light (50 % by chance, 62 % or more "
      "among "
      "rocks), as on leaves, roofs and ripples or under a wrong sun: their confidences are lowered so that "
      "at "
      "most {:.0f} % count as real",
      100 * seen.fraction(), seen.rocks, 100 * seen.real_fraction());
}

}  // namespace waymark::pipeline

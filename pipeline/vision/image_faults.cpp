// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/image_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {

std::optional<std::string> image_fault(const Pixels& pixels, double saturated) {
  constexpr std::int64_t kLeastSide = 16;
  constexpr double kBurnt = 0.05;
  if (std::min(pixels.columns(), pixels.rows()) < kLeastSide)
    return fmt::format("the image measures {} x {} pixels: nothing can be seen in it", pixels.columns(),
                       pixels.rows());
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  std::int64_t burnt = 0, known = 0;
  for (const float value : pixels.cells()) {
    if (std::isnan(value)) continue;
    ++known;
    lowest = std::min(lowest, double(value)), highest = std::max(highest, double(value));
    burnt += saturated > 0 && double(value) >= saturated;
  }
  if (known == 0) return "all pixels of the image are no data: nothing is found in it";
  if (!(highest > lowest))
    return fmt::format("all pixels of the image are {:g}: nothing is found in it", lowest);
  if (double(burnt) > kBurnt * double(known))
    return fmt::format(
        "{:.0f} % of the image's pixels are saturated: what lies in them is not found; a shorter exposure "
        "would show it",
        100 * double(burnt) / double(known));
  return std::nullopt;
}

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/image_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::pipeline {

std::optional<std::string> image_fault(const Pixels& pixels, double saturated) {
  constexpr std::int64_t kMinSide = 16;
  constexpr double kMaxSaturated = 0.05;
  if (std::min(pixels.columns(), pixels.rows()) < kMinSide)
    return fmt::format("the image has {} x {} pixels: too small for detection", pixels.columns(),
                       pixels.rows());
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  std::int64_t saturated_count = 0, known = 0;
  for (const float value : pixels.cells()) {
    if (std::isnan(value)) continue;
    ++known;
    lowest = std::min(lowest, double(value)), highest = std::max(highest, double(value));
    saturated_count += saturated > 0 && double(value) >= saturated;
  }
  if (known == 0) return "all pixels of the image are no data: nothing can be detected";
  if (!(highest > lowest))
    return fmt::format("all pixels of the image are {:g}: nothing can be detected", lowest);
  if (double(saturated_count) > kMaxSaturated * double(known))
    return fmt::format(
        "{:.0f} % of the pixels of the image are saturated: objects in them are not detected; use a shorter "
        "exposure",
        100 * double(saturated_count) / double(known));
  return std::nullopt;
}

}  // namespace waymark::pipeline

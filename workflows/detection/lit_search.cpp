// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/lit_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::workflows {
namespace {

constexpr double kMaxSaturated = 0.05;    // fraction of saturated pixels worth a warning
constexpr double kMaxSunDifference = 15;  // degrees between the given and the estimated sun

std::optional<Light> light_of(const ImageSource& image, const LitSearch& search) {
  std::vector<Light> all;
  for (const Window& window : sample_windows(image.info(), search.sample))
    if (const auto light = search.estimate(image.read(window))) all.push_back(*light);
  return search.choose(all);
}

std::string percent(std::int64_t part, std::int64_t of) {
  return fmt::format("{:.0f} %", 100 * static_cast<double>(part) / static_cast<double>(of));
}

/// Returns why nothing can be seen, or an empty text. Adds warnings.
std::string reason_for_no_detections(const ImageSource& image, std::vector<std::string>& warnings) {
  const ImageInfo& info = image.info();
  if (std::min(info.columns, info.rows) < kMinSide)
    return fmt::format("the image measures {} x {} pixels: too little to see anything in", info.columns,
                       info.rows);
  const Brightness light = measure_brightness(image);
  if (light.no_data == light.pixels) return "no pixel of the image holds data";
  if (light.darkest == light.brightest)
    return fmt::format("all pixels of the image are {:g}: there is nothing to be seen in it", light.darkest);
  if (light.no_data > light.pixels / 2)
    warnings.push_back(percent(light.no_data, light.pixels) + " of the image hold no data");
  if (static_cast<double>(light.saturated) > kMaxSaturated * static_cast<double>(light.pixels))
    warnings.push_back(fmt::format(
        "{} of the pixels are saturated: what lies in them is not found; a shorter exposure would show it",
        percent(light.saturated, light.pixels)));
  return {};
}

/// Returns the direction to search with; notes an estimate or a conflict in `found`.
std::optional<Radians> choose_light(const DetectionPlan& plan, const LitSearch& search, DetectResult& found) {
  const auto seen = light_of(*plan.image, search);
  if (plan.image_sun_angle) {
    const double given = plan.image_sun_angle->value;
    const double off = seen ? std::abs(std::remainder(seen->angle - given, 360)) : 0;
    if (seen && off > kMaxSunDifference + 2 * seen->sd)
      found.warnings.push_back(fmt::format(
          "the light is said to come from {:.0f} degrees in the image, but {} {} say {:.0f} +- {:.0f}: check "
          "that the angle counts from right towards down, and points towards the sun",
          given, seen->support, search.witness, seen->angle, seen->sd));
    return to_radians(*plan.image_sun_angle);
  }
  if (!seen) {
    found.warnings.push_back(search.unknown_light);
    return {};
  }
  found.light = fmt::format("light from {:.1f} +- {:.1f} degrees in the image, by {} {}", seen->angle,
                            seen->sd, seen->support, search.witness);
  return to_radians(Degrees{seen->angle});
}

}  // namespace

DetectResult search_lit_image(const DetectionPlan& plan, const LitSearch& search) {
  DetectResult found;
  found.detections = empty_detections(plan);
  if (const std::string reason = reason_for_no_detections(*plan.image, found.warnings); !reason.empty()) {
    found.warnings.push_back(reason);
    return found;
  }
  const auto sun = choose_light(plan, search, found);
  if (search.needs_light && !sun) return found;
  found.detections.sun_angle = sun;
  found.detections.detections = search_image(*plan.image, plan.search, search.make(sun));
  return found;
}

}  // namespace waymark::workflows

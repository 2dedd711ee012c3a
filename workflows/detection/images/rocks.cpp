// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <mutex>

#include "pipeline/light_in_image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "workflows/detection/lit_search.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kRockSample = 1000;  // side of the pieces that the light is estimated from, pixels

std::optional<Light> rock_light(const Pixels& pixels) {
  const auto seen = pipeline::sun_angle_for_rocks(pixels);
  if (seen) return Light{to_degrees(seen->angle).value, to_degrees(seen->sd).value, seen->shadows};
  return {};
}

/// Returns the most certain of the estimates with which most others agree; none if as many contradict it.
std::optional<Light> agreed_light(const std::vector<Light>& all) {
  constexpr double kAgree = 30;  // degrees
  const Light* best = nullptr;
  std::size_t max_agreeing = 0;
  for (const Light& one : all) {
    const auto agreeing = static_cast<std::size_t>(std::ranges::count_if(all, [&](const Light& other) {
      return std::abs(std::remainder(other.angle - one.angle, 360)) < kAgree;
    }));
    if (best != nullptr && (agreeing < max_agreeing || (agreeing == max_agreeing && !(one.sd < best->sd))))
      continue;
    best = &one;
    max_agreeing = agreeing;
  }
  if (best == nullptr || 2 * max_agreeing <= all.size()) return {};
  return *best;
}

/// Sums over the pieces of an image.
struct DoubtfulGround {
  std::mutex mutex;
  pipeline::LightCoherence seen;  ///< of pieces in which rocks are not lit as rocks are
  pipeline::ShadedGround shaded;
};

ObjectDetector rock_detector(const DetectionPlan& plan, std::optional<Radians> sun,
                             DoubtfulGround& doubtful) {
  return [=, &plan, &doubtful](const Pixels& pixels, double min, double max) {
    pipeline::RockSearch search;
    search.method = plan.method == "classic" ? pipeline::RockMethod::classic : pipeline::RockMethod::shadow;
    search.type = plan.type;
    search.sun_angle = sun;
    if (plan.sun_elevation) search.sun_elevation = to_radians(*plan.sun_elevation);
    search.min_diameter = min;
    search.max_diameter = max;
    search.min_confidence = plan.min_confidence.value_or(kUsualConfidence);
    pipeline::RocksFound found = pipeline::search_rocks(pixels, search);
    const std::scoped_lock lock(doubtful.mutex);
    if (found.coherence.real_fraction() < 1) doubtful.seen += found.coherence;
    doubtful.shaded += found.shaded;
    return std::move(found.rocks);
  };
}

DetectResult detect_rocks(const DetectionPlan& plan) {
  DoubtfulGround doubtful;
  DetectResult found = search_lit_image(
      plan, {.sample = kRockSample,
             .estimate = rock_light,
             .choose = agreed_light,
             .witness = "shadows or craters",
             .unknown_light =
                 "the image does not show where its light comes from, so shadows cannot be distinguished "
                 "from other dark spots: no rocks are reported; pass --image-sun-angle",
             .needs_light = true,
             .make = [&](std::optional<Radians> sun) { return rock_detector(plan, sun, doubtful); }});
  if (!found.detections.sun_angle) return found;
  if (doubtful.seen.rocks > 0) found.warnings.push_back(pipeline::unusual_ground_warning(doubtful.seen));
  if (doubtful.shaded.is_much()) found.warnings.push_back(pipeline::shaded_ground_warning(doubtful.shaded));
  if (!plan.sun_elevation && (plan.image->info().ortho || plan.gsd))
    found.warnings.push_back("rocks have no heights: they need --sun-elevation");
  return found;
}

}  // namespace

void register_image_rocks(ImageDetectorTable& detectors);
void register_image_rocks(ImageDetectorTable& detectors) {
  detectors.add({.name = "rocks",
                 .summary = "Rocks, by the shadows that they cast",
                 .type = "rock",
                 .methods = {{"shadow"}, {"classic"}},
                 .search = {.min_diameter = 1.5, .max_diameter = 100, .reduce_for_large = false},
                 .smallest = 1,
                 .make = [] { return ImageDetector{.find = detect_rocks}; }});
}

}  // namespace waymark::workflows

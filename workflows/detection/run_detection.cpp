// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/run_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "pipeline/craters/find_craters.hpp"
#include "pipeline/light_in_image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
#include "workflows/detection/tree_detection.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kSample = 1536;      // side of the pieces the light is estimated from, pixels
constexpr std::int64_t kRockSample = 1000;  // the same for rocks
constexpr std::int64_t kMinSide = 16;       // detectors see nothing in smaller images
constexpr double kMaxSaturated = 0.05;      // fraction of saturated pixels worth a warning
constexpr double kMaxSunDifference = 15;    // degrees between the given and the estimated sun

struct Light {
  double angle = 0, sd = 0;  ///< degrees
  int support = 0;           ///< shadows or craters that agreed
};

std::optional<Light> estimate_light(const Pixels& pixels, const std::string& type) {
  if (type == "crater") {
    const auto seen = pipeline::estimate_crater_sun_angle(pixels);
    if (seen) return Light{to_degrees(seen->angle).value, to_degrees(seen->sd).value, seen->craters};
    return {};
  }
  const auto seen = pipeline::estimate_rock_sun_angle(pixels, pipeline::crater_sun_angle(pixels));
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

std::optional<Light> best_light(const ImageSource& image, const std::string& type) {
  std::vector<Light> all;
  for (const Window& window : sample_windows(image.info(), type == "rock" ? kRockSample : kSample))
    if (const auto light = estimate_light(image.read(window), type)) all.push_back(*light);
  if (type == "rock") return agreed_light(all);
  const auto best = std::ranges::max_element(all, {}, &Light::support);
  return best == all.end() ? std::optional<Light>{} : *best;
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

/// Sums over the pieces of an image.
struct DoubtfulGround {
  std::mutex mutex;
  pipeline::LightCoherence seen;  ///< of pieces in which rocks are not lit as rocks are
  pipeline::ShadedGround shaded;
};

ObjectDetector detector(const DetectionPlan& plan, TypeId type, std::optional<Radians> sun,
                        DoubtfulGround& doubtful) {
  if (plan.type == "crater")
    return [=, &plan](const Pixels& pixels, double min, double max) {
      pipeline::CraterSearch search;
      search.verifier = plan.verifier.get();
      search.method = plan.method == "edges" ? pipeline::CraterMethod::edges : pipeline::CraterMethod::bowl;
      search.type = type;
      search.sun_angle = sun;
      search.min_diameter = min;
      search.max_diameter = max;
      search.min_confidence = plan.min_confidence;
      const double largest = 0.6 * static_cast<double>(std::min(pixels.columns(), pixels.rows()));
      if (std::min(pixels.columns(), pixels.rows()) < kMinSide || largest <= min)
        return std::vector<Detection>{};
      return pipeline::find_craters(pixels, search);
    };
  return [=, &plan, &doubtful](const Pixels& pixels, double min, double max) {
    pipeline::RockSearch search;
    search.method = plan.method == "classic" ? pipeline::RockMethod::classic : pipeline::RockMethod::shadow;
    search.type = type;
    search.sun_angle = sun;
    if (plan.sun_elevation) search.sun_elevation = to_radians(*plan.sun_elevation);
    search.min_diameter = min;
    search.max_diameter = max;
    search.min_confidence = plan.min_confidence;
    pipeline::RocksFound found = pipeline::search_rocks(pixels, search);
    const std::scoped_lock lock(doubtful.mutex);
    if (found.coherence.real_fraction() < 1) doubtful.seen += found.coherence;
    doubtful.shaded += found.shaded;
    return std::move(found.rocks);
  };
}

/// Returns the direction to search with; notes an estimate or a conflict in `found`.
std::optional<Radians> choose_light(const DetectionPlan& plan, DetectResult& found) {
  const auto seen = best_light(*plan.image, plan.type);
  const char* witness = plan.type == "crater" ? "craters" : "shadows or craters";
  if (plan.image_sun_angle) {
    const double given = plan.image_sun_angle->value;
    const double off = seen ? std::abs(std::remainder(seen->angle - given, 360)) : 0;
    if (seen && off > kMaxSunDifference + 2 * seen->sd)
      found.warnings.push_back(fmt::format(
          "the light is said to come from {:.0f} degrees in the image, but {} {} say {:.0f} +- {:.0f}: check "
          "that the angle counts from right towards down, and points towards the sun",
          given, seen->support, witness, seen->angle, seen->sd));
    return to_radians(*plan.image_sun_angle);
  }
  if (!seen) {
    found.warnings.push_back(
        plan.type == "crater"
            ? "the image does not show where its light comes from: few craters will be found; pass "
              "--image-sun-angle"
            : "the image does not show where its light comes from, so shadows cannot be distinguished from "
              "other dark "
              "spots: no rocks are reported; pass --image-sun-angle");
    return {};
  }
  found.light = fmt::format("light from {:.1f} +- {:.1f} degrees in the image, by {} {}", seen->angle,
                            seen->sd, seen->support, witness);
  return to_radians(Degrees{seen->angle});
}

}  // namespace

exporters::ImageDetections empty_detections(const DetectionPlan& plan, TypeId type) {
  const ImageInfo& info = plan.image->info();
  return {.type = type,
          .image = info.name,
          .columns = info.columns,
          .rows = info.rows,
          .detections = {},
          .georeference = info.ortho,
          .gsd = plan.gsd,
          .sun_elevation = plan.sun_elevation,
          .sun_azimuth = plan.sun_azimuth};
}

DetectResult run_detection(const DetectionPlan& plan, int threads,
                           const pipeline::ProgressMeter::Listener& progress) {
  if (plan.type == "tree") return detect_trees(plan, threads, progress);
  const ImageInfo& info = plan.image->info();
  const TypeId type = all_types().id(plan.type);
  DetectResult found;
  found.detections = empty_detections(plan, type);
  if (const std::string reason = reason_for_no_detections(*plan.image, found.warnings); !reason.empty()) {
    found.warnings.push_back(reason);
    return found;
  }
  const auto sun = choose_light(plan, found);
  ImageSearch search = plan.search;
  search.threads = threads;
  search.progress = progress;
  if (plan.type == "rock" && !sun) return found;
  found.detections.sun_angle = sun;
  DoubtfulGround doubtful;
  found.detections.detections = search_image(*plan.image, search, detector(plan, type, sun, doubtful));
  if (doubtful.seen.rocks > 0) found.warnings.push_back(pipeline::unusual_ground_warning(doubtful.seen));
  if (doubtful.shaded.is_much()) found.warnings.push_back(pipeline::shaded_ground_warning(doubtful.shaded));
  if (plan.type == "rock" && !plan.sun_elevation && (info.ortho || plan.gsd))
    found.warnings.push_back("rocks have no heights: they need --sun-elevation");
  return found;
}

}  // namespace waymark::workflows

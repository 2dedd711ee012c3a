// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/image_source.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/light_in_image.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
#include "pipeline/vision/sun_angle_in_image.hpp"

namespace waymark::pipeline {
namespace {

/// Comparison of the given sun with the shadows of an image.
struct SunCheck {
  bool known = false, seen = false;
  double off = 0;  ///< degrees, [0, 180]
  double sd = 0;
  int shadows = 0;
};

struct CheckSun {
  struct Options {
    Degrees tolerance{15};
    std::int64_t max_pixels = 2048;
    void describe(OptionVisitor& option) {
      option("tolerance", tolerance,
             {.help = "Largest difference between given sun and shadows without a warning",
              .min = 1,
              .max = 180});
      option("max_pixels", max_pixels,
             {.help = "Side of the central square of the image that is examined",
              .min = 64,
              .max = 65536,
              .formerly = "most_pixels"});
    }
  };
  static constexpr In<ImageSet> image_set{"image_set"};

  static StageSpec spec() {
    return {.name = "check_sun",
            .summary = "Compares the given sun with the shadows in each image and warns where they disagree",
            .version = 3,
            .scope = Scope::image,
            .inputs = {image_set}};
  }

  static double angle_between(Radians a, Radians b) {
    return std::abs(std::remainder(a.value - b.value, 2 * std::numbers::pi)) / kRadiansPerDegree;
  }

  static Pixels central_window(const ImageSource& image, std::int64_t max_side) {
    const std::int64_t columns = std::min(image.info().columns, max_side),
                       rows = std::min(image.info().rows, max_side);
    return image.read({(image.info().columns - columns) / 2, (image.info().rows - rows) / 2, columns, rows});
  }

  static SunCheck check(const ImageSource& image, const Options& options) {
    SunCheck made;
    const auto given = sun_angle_in_image(image.info());
    made.known = given.has_value();
    if (!given) return made;
    const Pixels pixels = central_window(image, options.max_pixels);
    auto seen = estimate_rock_sun_angle(pixels);
    // Hollows look like rocks under the opposite sun, so craters decide before a warning.
    if (!seen || angle_between(seen->angle, *given) > options.tolerance.value)
      seen = estimate_rock_sun_angle(pixels, crater_sun_angle(pixels));
    if (!seen) return made;
    made.off = angle_between(seen->angle, *given);
    made.sd = seen->sd.value / kRadiansPerDegree;
    made.shadows = seen->shadows;
    made.seen = true;
    return made;
  }

  static void run(const Options& options, StageContext& unit) {
    const ImageSource& image = *unit.read(image_set).at(static_cast<std::size_t>(unit.image().index));
    if (image.info().columns == 0) return;  // missing: load_images has warned
    const SunCheck found = check(image, options);
    const std::string& name = image.info().name;
    if (!found.known)
      unit.warn(fmt::format("{}: the sun is not known: detectors estimate it from the image", name));
    // Differences below three standard deviations are not significant.
    if (!found.seen || !(found.off > std::max(options.tolerance.value, 3 * found.sd))) return;
    const bool opposite = found.off > 180 - options.tolerance.value;
    unit.warn(fmt::format(
        "{}: {} shadows point {:.0f} deg (sd {:.0f}) away from where the given sun puts them{}", name,
        found.shadows, found.off, found.sd,
        opposite ? ": towards the sun; either the azimuth given is the shadows', or most are hollows"
                 : "; check azimuth (clockwise from map north), time zone and pose"));
  }
};

}  // namespace

void register_stage_check_sun(Registry& registry);
void register_stage_check_sun(Registry& registry) {
  registry.add<CheckSun>();
}

}  // namespace waymark::pipeline

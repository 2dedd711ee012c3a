// SPDX-License-Identifier: Apache-2.0
#include "geo/image_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/light_in_image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/vision/image_faults.hpp"
#include "pipeline/vision/sun_angle_in_image.hpp"

namespace waymark::pipeline {
namespace {

struct RocksFromShadows {
  struct Options {
    std::string method = "shadow";
    RockSearch search;
    void describe(OptionVisitor& option) {
      option("method", method,
             {.help = "Segmentation of shadows: shadow (against the ground around each), classic (one "
                      "threshold, as published)",
              .choices = {"shadow", "classic"}});
      option("min_diameter", search.min_diameter,
             {.help = "Smallest rock kept, in pixels of the image", .min = 0.5, .max = 1e4});
      option("max_diameter", search.max_diameter,
             {.help = "Largest rock kept, in pixels of the image", .min = 1, .max = 1e5});
      option("min_confidence", search.min_confidence,
             {.help = "Rocks less probable than this are left out", .min = 0, .max = 1});
      option("blur", search.blur,
             {.help = "Standard deviation of the camera's point spread, in pixels; 0: unknown, uses 0.6",
              .min = 0,
              .max = 5});
    }
  };
  static constexpr In<ImageSet> image_set{"image_set"};
  static constexpr Out<std::vector<Detection>> detections{"detections"};

  static StageSpec spec() {
    return {.name = "rocks_from_shadows",
            .summary = "Finds rocks in an image by their shadows, with widths, heights and confidence",
            .version = 9,
            .scope = Scope::image,
            .inputs = {image_set},
            .outputs = {detections}};
  }

  static void run(const Options& options, StageContext& unit) {
    const ImageSource& image = *unit.read(image_set).at(static_cast<std::size_t>(unit.image().index));
    RockSearch search = options.search;
    search.method = options.method == "classic" ? RockMethod::classic : RockMethod::shadow;
    search.type = unit.types().id("rock");
    search.sun_angle = sun_angle_in_image(image.info());
    if (image.info().view) search.displacement = relief_displacement_of(*image.info().view);
    if (image.info().sun) search.sun_elevation = to_radians(image.info().sun->elevation);
    const Pixels pixels = image.read({0, 0, image.info().columns, image.info().rows});
    if (const auto fault = image_fault(pixels, image.info().saturated)) unit.warn(*fault);
    if (!search.sun_angle) search.crater_sun = crater_sun_angle(pixels);
    RocksFound found = search_rocks(pixels, search);
    if (!found.light)
      unit.warn(image.info().name +
                ": the sun is unknown, and the image does not show where its light comes from: no rocks");
    if (found.coherence.real_fraction() < 1)
      unit.warn(image.info().name + ": " + unusual_ground_warning(found.coherence));
    if (found.shaded.is_much()) unit.warn(image.info().name + ": " + shaded_ground_warning(found.shaded));
    unit.count_out(static_cast<std::int64_t>(found.rocks.size()));
    unit.write(detections, std::move(found.rocks));
  }
};

}  // namespace

void register_stage_rocks_from_shadows(Registry& registry);
void register_stage_rocks_from_shadows(Registry& registry) {
  registry.add<RocksFromShadows>();
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/light_in_image.hpp"
#include "pipeline/vision/image_faults.hpp"
#include "pipeline/vision/sun_angle_in_image.hpp"
namespace waymark::pipeline {

/// Stage that detects craters in one image by a given method.
template <CraterMethod kMethod>
struct CratersInImage {
  struct Options {
    /// - Doubtful bowls are kept, since project_to_ground decides on them where heights are known.
    /// - In maps the heights give the second opinion; with the verifier, too, maps of landings lost recall
    ///   (docs/evaluation/2026-11-25-craters-of-measured-relief.md).
    CraterSearch search = {
        .method = kMethod,
        .min_confidence = kMethod == CraterMethod::bowl ? 0.1 : CraterSearch{}.min_confidence,
        .second_opinion = false};
    void describe(OptionVisitor& option) {
      option("min_diameter", search.min_diameter,
             {.help = "Smallest crater kept, in pixels of the image", .min = 6, .max = 1e5});
      option("max_diameter", search.max_diameter,
             {.help = "Largest crater kept, in pixels; 0: 0.6 of the image's shorter side",
              .min = 0,
              .max = 1e6});
      option("min_confidence", search.min_confidence,
             {.help = "Craters less probable than this are left out", .min = 0, .max = 1});
    }
  };
  static constexpr In<ImageSet> image_set{"image_set"};
  static constexpr Out<std::vector<Detection>> detections{"detections"};

  static StageSpec make_spec(std::string name, std::string summary, int version) {
    return {.name = std::move(name),
            .summary = std::move(summary),
            .version = version,
            .scope = Scope::image,
            .inputs = {image_set},
            .outputs = {detections}};
  }

  // Of an unknown sun: craters of many sizes show it, else the shadows of rocks.
  static std::optional<Radians> sun_angle(const ImageInfo& image, const Pixels& pixels) {
    if (const auto given = sun_angle_in_image(image)) return given;
    return sun_angle_of_ground(pixels);
  }

  static void run(const Options& options, StageContext& unit) {
    const ImageSource& image = *unit.read(image_set).at(static_cast<std::size_t>(unit.image().index));
    const Pixels pixels = image.read({0, 0, image.info().columns, image.info().rows});
    if (const auto fault = image_fault(pixels, image.info().saturated)) unit.warn(*fault);
    const std::optional<Radians> sun = sun_angle(image.info(), pixels);
    if (!sun) {
      if (pixels.columns() > 0)
        unit.warn(image.info().name +
                  ": the sun is unknown, and the image does not show where its light comes from: no craters");
      unit.write(detections, std::vector<Detection>{});
      return;
    }
    CraterSearch search = options.search;
    search.type = unit.types().id("crater");
    search.sun_angle = sun;
    auto found = find_craters(pixels, search);
    unit.count_out(static_cast<std::int64_t>(found.size()));
    unit.write(detections, std::move(found));
  }
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/find_craters.hpp"

#include <algorithm>

#include "core/text_file.hpp"
#include "pipeline/craters/relief_verifier.hpp"
#include "pipeline/light_in_image.hpp"
#include "workflows/detection/lit_search.hpp"

namespace waymark::workflows {
namespace {

struct CraterSettings {
  std::string verifier;
  std::shared_ptr<const pipeline::ReliefVerifier> read_verifier;  ///< null: the shipped one

  void describe(OptionVisitor& option) {
    option("verifier", verifier,
           {.help = "verifier that `waymark train craters --labels` wrote, instead of the shipped one"});
  }
  void prepare() {
    if (!verifier.empty())
      read_verifier = std::make_shared<const pipeline::ReliefVerifier>(
          pipeline::parse_relief_verifier(read_text(verifier, "the verifier"), verifier));
  }
};

std::optional<Light> crater_light(const Pixels& pixels) {
  const auto seen = pipeline::sun_angle_for_craters(pixels);
  if (seen) return Light{to_degrees(seen->angle).value, to_degrees(seen->sd).value, seen->shadows};
  return {};
}

std::optional<Light> most_supported(const std::vector<Light>& all) {
  const auto best = std::ranges::max_element(all, {}, &Light::support);
  return best == all.end() ? std::optional<Light>{} : *best;
}

std::vector<Detection> craters_of_piece(const Pixels& pixels, pipeline::CraterSearch search) {
  const double largest = 0.6 * static_cast<double>(std::min(pixels.columns(), pixels.rows()));
  if (std::min(pixels.columns(), pixels.rows()) < kMinSide || largest <= search.min_diameter) return {};
  return pipeline::find_craters(pixels, search);
}

DetectResult detect_craters(const DetectionPlan& plan, const CraterSettings& settings) {
  pipeline::CraterSearch search;
  search.verifier = settings.read_verifier.get();
  search.method = plan.method == "edges" ? pipeline::CraterMethod::edges : pipeline::CraterMethod::bowl;
  search.type = plan.type;
  search.min_confidence = plan.min_confidence.value_or(kUsualConfidence);
  return search_lit_image(
      plan,
      {.estimate = crater_light,
       .choose = most_supported,
       .witness = "craters or boulders",
       .unknown_light = "the image does not show where its light comes from: few craters will be found; "
                        "pass --image-sun-angle",
       .make = [search](std::optional<Radians> sun) mutable -> ObjectDetector {
         search.sun_angle = sun;
         return [search](const Pixels& pixels, double min, double max) mutable {
           search.min_diameter = min;
           search.max_diameter = max;
           return craters_of_piece(pixels, search);
         };
       }});
}

}  // namespace

void register_image_craters(ImageDetectorTable& detectors);
void register_image_craters(ImageDetectorTable& detectors) {
  detectors.add(
      {.name = "craters",
       .summary = "Craters, by their shading or by edges",
       .type = "crater",
       .methods = {{"bowl"}, {"edges"}},
       .search = {.min_diameter = 8},
       .smallest = 6,
       .max_diameter_text = "0.6 of the shorter side",
       .setting_use = {{.name = "verifier", .value = "FILE", .methods = {"bowl"}, .is_file = true}},
       .make = [] {
         const auto settings = std::make_shared<CraterSettings>();
         return ImageDetector{
             .describe = [settings](OptionVisitor& option) { settings->describe(option); },
             .prepare = [settings] { settings->prepare(); },
             .find = [settings](const DetectionPlan& plan) { return detect_craters(plan, *settings); }};
       }});
}

}  // namespace waymark::workflows

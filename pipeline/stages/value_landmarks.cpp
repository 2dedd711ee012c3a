// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/projection/dem_terrain.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "pipeline/stages/valued_parts.hpp"

namespace waymark::pipeline {
namespace {

struct ValueLandmarks {
  struct Options {
    std::string covers = "sound";
    std::string spread = "sound";
    double min_diameter = 0;
    bool keep_improbable = false;
    void describe(OptionVisitor& option) {
      option(
          "covers", covers,
          {.help = "Rule for images that cover a landmark: sound (complete, not occluded, at least as sharp "
                   "as the coarsest that detected it) or paper (eq. 4: footprint and its area)",
           .choices = {"sound", "paper"}});
      option("spread", spread,
             {.help = "Confidence from spread: sound (by scale, absent for one observation) or paper "
                      "(eqs. 6-7 literally)",
              .choices = {"sound", "paper"}});
      option("min_diameter", min_diameter,
             {.help = "Smallest landmark that an image can detect, in pixels",
              .min = 0,
              .max = 1000,
              .formerly = "least_diameter"});
      option("keep_improbable", keep_improbable,
             {.help = "Keep landmarks that are probably false (rocks and craters below 0.5)"});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<std::vector<ImageView>> aligned_views{"aligned_views"};
  static constexpr Out<std::vector<ImageView>> image_views{"image_views"};

  static StageSpec spec() {
    return {.name = "value_landmarks",
            .summary = "Values landmarks: multiplicity, spread of features, probability of existence",
            .version = 9,
            .scope = Scope::map,
            .inputs = {dem, aligned_views, ValuedParts::merged, ValuedParts::merged_evidence},
            .outputs = {ValuedParts::landmarks, ValuedParts::evidence, ValuedParts::rejected, image_views}};
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    const std::vector<ImageView>& images = unit.read(aligned_views);
    const DemHandle& ground = unit.read(dem);
    const Terrain terrain = load_terrain(ground);
    ValuationRules rules;
    rules.cover = options.covers == "paper" ? CoverRule::paper : CoverRule::sound;
    rules.spread = options.spread == "paper" ? SpreadRule::paper : SpreadRule::sound;
    rules.coverage.min_diameter = options.min_diameter;
    ValuedParts::write(
        unit,
        [&](LandmarkList& all, ObservationList& seen) {
          value_landmarks(all, seen, images, &terrain, types, ground->geometry().where.crs.metres_per_unit(),
                          rules);
          if (!options.keep_improbable)
            unit.reject("landmark improbable", remove_improbable(all, seen, types));
        },
        [&](double x, double y) { return ground->in_area(x, y); });
    unit.write(image_views, images);
  }
};

}  // namespace

void register_stage_value_landmarks(Registry& registry);
void register_stage_value_landmarks(Registry& registry) {
  registry.add<ValueLandmarks>();
}

}  // namespace waymark::pipeline

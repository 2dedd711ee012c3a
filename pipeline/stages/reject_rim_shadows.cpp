// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/cleaning/rejection_counter.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"

namespace waymark::pipeline {
namespace {

// Map scope: a crater in a coarse image explains shadows in a fine one that shows only its rim.
struct RejectRimShadows {
  struct Options {
    RimShadowRules rules = {};  // but for the angle, in degrees for people
    Degrees half_angle = to_degrees(Radians{RimShadowRules{}.half_angle});
    void describe(OptionVisitor& option) {
      option("inner", rules.inner,
             {.help = "Inner limit of the rim band, in radii of the crater", .min = 0, .max = 1});
      option("outer", rules.outer,
             {.help = "Outer limit of the rim band, in radii of the crater", .min = 1, .max = 5});
      option("half_angle", half_angle,
             {.help = "Half angle around the sun's direction in which a rim faces the light",
              .min = 0,
              .max = 180});
      option("min_fraction", rules.min_fraction,
             {.help = "Smallest size, as a fraction of the crater's, of a rock that is rejected",
              .min = 0,
              .max = 1,
              .formerly = "min_share"});
      option("min_confidence", rules.min_confidence,
             {.help = "Smallest confidence of a crater whose rim rejects rocks", .min = 0, .max = 1});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Gather<ImageView> image_view{"image_view"};
  static constexpr Gather<std::vector<Observation>> lit{"lit"};
  static constexpr Out<std::vector<Observation>> cleaned{"cleaned"};

  static StageSpec spec() {
    return {.name = "reject_rim_shadows",
            .summary = "Rejects rocks on the light-facing rims of craters, where the shadow is the crater's",
            .version = 1,
            .scope = Scope::map,
            .inputs = {dem, image_view, lit},
            .outputs = {cleaned}};
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::map<std::string, Sun> suns;
    for (const auto& image : unit.read_all(image_view))
      if (image->sun) suns[image->name] = *image->sun;
    std::vector<Observation> all;
    for (const auto& part : unit.read_all(lit)) all.insert(all.end(), part->begin(), part->end());
    RejectionCounter count(unit, all);
    RimShadowRules rules = options.rules;
    rules.half_angle = to_radians(options.half_angle).value;
    reject_rim_shadows(all, all, types, suns, unit.read(dem)->geometry().where.crs, rules);
    count.close(all);
    unit.write(cleaned, std::move(all));
  }
};

}  // namespace

void register_stage_reject_rim_shadows(Registry& registry);
void register_stage_reject_rim_shadows(Registry& registry) {
  registry.add<RejectRimShadows>();
}

}  // namespace waymark::pipeline

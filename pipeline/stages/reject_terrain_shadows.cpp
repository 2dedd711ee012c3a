// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/cleaning/rejection_counter.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"
#include "pipeline/fusion/projection/dem_terrain.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"

namespace waymark::pipeline {
namespace {

struct RejectTerrainShadows {
  struct Options {
    TerrainShadowRules rules = {};
    void describe(OptionVisitor& option) {
      option("min_distance_cells", rules.min_distance_cells,
             {.help = "Smallest distance of shadow-casting terrain, in cells of the DEM",
              .min = 0,
              .max = 1000});
      option("min_cells", rules.relief.min_cells,
             {.help = "Smallest diameter, in cells of the DEM, of a rock that the DEM's relief can refute",
              .min = 1,
              .max = 1000});
      option("min_drop", rules.relief.min_drop,
             {.help = "Smallest fraction of the light that the DEM's relief takes from a shadow's area to "
                      "refute its rock; 1: never",
              .min = 0,
              .max = 1});
      option("min_stands_out", rules.relief.min_stands_out,
             {.help = "Smallest fraction of its height by which a rock stands out of a fine DEM, to be kept",
              .min = 0,
              .max = 1});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<ImageView> image_view{"image_view"};
  static constexpr In<std::vector<Observation>> plausible{"plausible"};
  static constexpr Out<std::vector<Observation>> lit{"lit"};

  static StageSpec spec() {
    return {.name = "reject_terrain_shadows",
            .summary = "Rejects rocks whose shadow the terrain explains, by tracing rays to the sun",
            .version = 2,
            .scope = Scope::image,
            .inputs = {dem, image_view, plausible},
            .outputs = {lit}};
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<Observation> all = unit.read(plausible);
    RejectionCounter count(unit, all);
    const DemHandle& ground = unit.read(dem);
    reject_terrain_shadows(all, types, unit.read(image_view), load_terrain(ground),
                           ground->geometry().where.crs.metres_per_unit(), options.rules);
    count.close(all);
    unit.write(lit, std::move(all));
  }
};

}  // namespace

void register_stage_reject_terrain_shadows(Registry& registry);
void register_stage_reject_terrain_shadows(Registry& registry) {
  registry.add<RejectTerrainShadows>();
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "geo/plane_dem.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::importers {
namespace {

struct FlatGround {
  struct Options {
    std::string crs;
    Meters height{0}, height_sd{0};
    void describe(OptionVisitor& option) {
      option(
          "crs", crs,
          {.help = "Projected coordinate reference system of the map: EPSG:32633, a PROJ string, or local"});
      option("height", height, {.help = "Height of the level ground", .min = -2e4, .max = 1e5});
      option("height_sd", height_sd,
             {.help = "Deviation of the real terrain from it: positions seen at an angle become less certain",
              .min = 0,
              .max = 1e4});
    }
  };
  static constexpr pipeline::Out<DemHandle> dem{"dem"};

  static pipeline::StageSpec spec() {
    return {.name = "flat_ground",
            .summary = "Level ground for images where there is no DEM: the map has no heights then",
            .version = 1,
            .scope = pipeline::Scope::map,
            .outputs = {dem}};
  }

  static void run(const Options& options, pipeline::StageContext& unit) {
    if (options.crs.empty())
      throw Error(ErrorCode::usage, "flat_ground does not know the map's CRS", "flat_ground.crs",
                  "name a projected CRS (EPSG:32633), or local for metres on no body");
    const Crs crs = options.crs == "local" ? Crs::local() : Crs::from_text(options.crs);
    unit.write(dem,
               DemHandle(std::make_shared<PlaneDem>(crs, options.height.value, options.height_sd.value)));
  }
};

}  // namespace

void register_stage_flat_ground(pipeline::Registry& registry);
void register_stage_flat_ground(pipeline::Registry& registry) {
  registry.add<FlatGround>();
}

}  // namespace waymark::importers

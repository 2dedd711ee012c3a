// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/craters/dem_blocks.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"

namespace waymark::pipeline {
namespace {

struct CratersFromDem {
  struct Options {
    DemSurvey survey;
    void describe(OptionVisitor& option) {
      option("min_diameter", survey.search.min_diameter,
             {.help = "Smallest crater kept, in cells of the DEM", .min = 6, .max = kMaxDemDiameter});
      option("max_diameter", survey.search.max_diameter,
             {.help = "Largest crater kept, in cells; larger ones need a coarser DEM",
              .min = 6,
              .max = kMaxDemDiameter});
      option("min_confidence", survey.search.min_confidence,
             {.help = "Craters less probable than this are left out", .min = 0, .max = 1});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Out<std::vector<Observation>> observations{"observations"};

  static StageSpec spec() {
    return {.name = "craters_from_dem",
            .summary = "Finds craters in a DEM: dishes with rims, their depth and rim height",
            .version = 3,
            .scope = Scope::tile,
            .halo = kDemCore + kDemMargin,
            .inputs = {dem},
            .outputs = {observations}};
  }

  static void run(const Options& options, StageContext& unit) {
    DemSurvey survey = options.survey;
    survey.type = unit.types().id("crater");
    auto found = survey_craters(*unit.read(dem), unit.tile().cells, survey);
    for (Observation& o : found) o.pixel.reset();  // only images of the map have pixels
    unit.count_out(static_cast<std::int64_t>(found.size()));
    unit.write(observations, std::move(found));
  }
};

}  // namespace

void register_stage_craters_from_dem(Registry& registry);
void register_stage_craters_from_dem(Registry& registry) {
  registry.add<CratersFromDem>();
}

}  // namespace waymark::pipeline

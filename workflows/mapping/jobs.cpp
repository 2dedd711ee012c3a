// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/jobs.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "pipeline/craters/dem_blocks.hpp"

namespace waymark::workflows {
namespace {

void check_files(const CanopyFiles& canopy) {
  const auto& [chm, dsm, dtm, las, flights, crowns] = canopy;
  const bool surface = !dsm.empty() || !dtm.empty();
  if (chm.empty() && las.empty() && !surface)
    throw Error(ErrorCode::usage, "no canopy is given", "",
                "pass --chm CHM.tif, or --dsm DSM.tif --dtm DTM.tif, or --las POINTS.las");
  if (!las.empty() && (surface || !chm.empty()))
    throw Error(ErrorCode::usage, "--las is given together with rasters", "",
                "points make their own canopy model: leave out one or the other");
  if (!chm.empty() && surface)
    throw Error(ErrorCode::usage, "--chm is given together with --dsm or --dtm", "",
                "a canopy height model needs no terrain: leave out one or the other");
  if (surface && (dsm.empty() || dtm.empty()))
    throw Error(ErrorCode::usage,
                dsm.empty() ? "--dtm is given without --dsm" : "--dsm is given without --dtm", "",
                "heights of trees are the surface less the terrain: give both");
}

}  // namespace

void add_mountain_top_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem) {
  pipeline.add("load_dem", nlohmann::json{{"files", dem}}.dump());
  for (const char* stage :
       {"find_mountain_tops", "join_mountain_tops", "measure_isolation", "mountain_tops_of_tile"})
    pipeline.add(stage);
}

void add_name_stage(pipeline::Pipeline& pipeline, const std::vector<std::string>& gazetteers) {
  pipeline.add("load_names", nlohmann::json{{"files", gazetteers}}.dump());
}

void add_crater_stages(pipeline::Pipeline& pipeline, const std::vector<std::string>& dem) {
  pipeline.add(
      "load_dem",
      nlohmann::json{{"files", dem}, {"nodata", "unknown"}, {"tile_cells", pipeline::kDemCore}}.dump());
  for (const char* stage : {"craters_from_dem", "merge_observations", "value_surveys"}) pipeline.add(stage);
}

void add_tree_stages(pipeline::Pipeline& pipeline, const CanopyFiles& canopy) {
  check_files(canopy);
  pipeline.add("load_canopy", nlohmann::json{{"chm", canopy.chm},
                                             {"dsm", canopy.dsm},
                                             {"dtm", canopy.dtm},
                                             {"las", canopy.las},
                                             {"flights", canopy.flights}}
                                  .dump());
  pipeline.add("trees_from_canopy", nlohmann::json{{"crowns", canopy.crowns}}.dump());
  if (!canopy.flights) {
    pipeline.add("trees_of_survey");
    return;
  }
  pipeline.add("merge_observations", nlohmann::json{{"overlap", 0.1}}.dump());
  pipeline.add("value_flights");
}

}  // namespace waymark::workflows

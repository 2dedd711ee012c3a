// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "apps/shortcut.hpp"
#include "workflows/mapping/make_map.hpp"

namespace waymark::apps {
namespace {

class Peaks final : public Shortcut {
 public:
  Peaks()
      : Shortcut({"find_mountain_tops.min_prominence", "mountain_tops_of_tile.min_isolation",
                  "load_dem.nodata", "join_mountain_tops.base", "measure_isolation.isolation",
                  "measure_isolation.distance", "mountain_tops_of_tile.visible_range", "load_dem.aoi",
                  "load_dem.crs", "load_dem.band", "load_dem.height_unit", "load_dem.height_scale",
                  "load_dem.height_sd", "load_dem.fill_distance", "load_dem.tile_cells", "load_dem.memory"}) {
  }

 private:
  CommandSpec describe_own() override {
    return {
        .name = "peaks",
        .group = Group::make,
        .summary = "Find the mountain tops of a DEM, with exact prominence and isolation",
        .about =
            "Several files that touch or overlap are one DEM. The result does not depend on --threads or "
            "--tile-cells. Every height that hidden ground could change comes with a certified lower bound.",
        .arguments = {file_word("DEM...", &files_,
                                "Elevation models that GDAL opens, /vsi paths too, - for standard input; "
                                "where they overlap the first "
                                "wins"),
                      Argument{"--names", "LAYER", &names_,
                               "Points with a column name, after which summits are named; may be repeated"}
                          .offering(Offer::file)},
        .examples = {
            {"waymark peaks alps.tif -o alps.gpkg --min-prominence 30",
             "A map of the summits that rise 30 m"},
            {"waymark peaks N41E001.hgt N42E001.hgt -o pyrenees.gpkg --nodata fill",
             "Two tiles with voids filled"},
            {"waymark peaks mola.tif -o mars.gpkg --base lowest --min-isolation 50000",
             "A global grid of Mars"},
            {"waymark peaks alps.tif -o valais.gpkg --aoi valais.geojson",
             "Summits of a region, measured on the whole DEM"},
            {"waymark peaks alps.tif --print-job > job.json", "The job, to change it and `waymark run` it"}}};
  }

  void add_stages(pipeline::Pipeline& pipeline) const override {
    std::vector<std::string> files = files_;
    std::ranges::replace(files, "-", "/vsistdin/");
    workflows::add_mountain_top_stages(pipeline, files);
    if (!names_.empty()) workflows::add_name_stage(pipeline, names_);
  }

  std::vector<std::string> files_, names_;
};

}  // namespace

void register_command_peaks(CommandTable& commands);
void register_command_peaks(CommandTable& commands) {
  commands.add<Peaks>();
}

}  // namespace waymark::apps

// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"
#include "workflows/mapping/make_map.hpp"

namespace waymark::apps {
namespace {

class Craters final : public Shortcut {
 public:
  Craters()
      : Shortcut({"craters_from_dem.min_diameter", "craters_from_dem.max_diameter",
                  "craters_from_dem.min_confidence", "load_dem.aoi", "load_dem.crs", "load_dem.tile_cells",
                  "load_dem.memory"}) {}

 private:
  CommandSpec describe_own() override {
    return {.name = "craters",
            .group = Group::make,
            .summary = "Find the craters of a DEM",
            .about =
                "Bowls with rims are detected in the heights at every size from --min-diameter to "
                "--max-diameter cells; each gets its ellipse, depth, rim height and a probability. "
                "Craters of images: `waymark detect craters`, or a job with craters_from_bowls.",
            .arguments = {Argument{"--dem", "DEM...", &files_,
                                   "Elevation models that GDAL opens; where they overlap the first counts"}
                              .needed()
                              .offering(Offer::file)},
            .examples = {{"waymark craters --dem gld100.tif -o craters.gpkg", "A map of the Moon's craters"},
                         {"waymark craters --dem ctx_dtm.tif -o craters.gpkg --min-confidence 0.8",
                          "Craters of high confidence only"},
                         {"waymark craters --dem mola.tif --print-job > job.json",
                          "The job, to change it and `waymark run` it"}}};
  }

  void add_stages(pipeline::Pipeline& pipeline) const override {
    workflows::add_crater_stages(pipeline, files_);
  }

  std::vector<std::string> files_;
};

}  // namespace

void register_command_craters(CommandTable& commands);
void register_command_craters(CommandTable& commands) {
  commands.add<Craters>();
}

}  // namespace waymark::apps

// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"
#include "workflows/mapping/make_map.hpp"

namespace waymark::apps {
namespace {

class Trees final : public Shortcut {
 public:
  Trees()
      : Shortcut({"trees_from_canopy.preset", "trees_from_canopy.method", "trees_from_canopy.min_height",
                  "trees_from_canopy.isolation_base", "trees_from_canopy.isolation_slope",
                  "trees_from_canopy.prominence", "trees_from_canopy.smoothing",
                  "trees_from_canopy.max_crown_radius", "trees_from_canopy.allometry",
                  "trees_from_canopy.species", "trees_from_canopy.roofs", "load_canopy.resolution",
                  "load_canopy.forest_type", "load_canopy.crs", "load_canopy.aoi", "load_canopy.tile_cells",
                  "load_canopy.memory"}) {}

 private:
  CommandSpec describe_own() override {
    std::vector<Argument> all = canopy_arguments(files_);
    all.push_back({"--flights", "", &files_.flights,
                   "Each file is a survey of its own: trees that several saw are merged and valued"});
    all.push_back({"--no-crowns", "", &no_crowns_, "Treetops alone: no crowns, no crown diameters"});
    return {
        .name = "trees",
        .group = Group::make,
        .summary = "Find the trees of a canopy, their crowns and stem diameters",
        .about =
            "A treetop is detected by its height, isolation and prominence, like a mountain top; its "
            "crown is the area that drains towards it with the canopy upside down. Stem diameters come "
            "from an allometry table: --allometry, made by `waymark allometry fit`. The map has a point "
            "per tree (height, diameter, crown_diameter) and a layer of crown polygons. It does not "
            "depend on --threads or --tile-cells.",
        .arguments = all,
        .examples = {
            {"waymark trees --chm chm.tif -o trees.gpkg --preset conifer", "A map of trees and crowns"},
            {"waymark trees --dsm dsm.tif --dtm dtm.tif -o trees.gpkg", "Surface less terrain"},
            {"waymark trees --las flight_*.laz -o trees.gpkg", "From laser points: ground, canopy, trees"},
            {"waymark trees --las tiles/ -o trees.gpkg", "All LAS, LAZ and COPC files of a folder"},
            {"waymark trees --las tiles/ --dtm official_dtm.tif -o trees.gpkg",
             "Canopy of the points above a terrain model"},
            {"waymark trees --chm 2019.tif 2023.tif --flights -o trees.gpkg",
             "Two surveys of one forest: trees are merged and valued"},
            {"waymark trees --chm chm.tif -o trees.gpkg --allometry table.csv --species PIAB",
             "Stem diameters of spruce"},
            {"waymark trees --chm chm.tif --print-job > job.json",
             "The job, to change it and `waymark run` it"}}};
  }

  void add_stages(pipeline::Pipeline& pipeline) const override {
    workflows::CanopyFiles files = files_;
    files.crowns = !no_crowns_;
    workflows::add_tree_stages(pipeline, files);
  }

  workflows::CanopyFiles files_;
  bool no_crowns_ = false;
};

}  // namespace

void register_command_trees(CommandTable& commands);
void register_command_trees(CommandTable& commands) {
  commands.add<Trees>();
}

}  // namespace waymark::apps

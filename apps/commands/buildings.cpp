// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"
#include "workflows/mapping/make_map.hpp"

namespace waymark::apps {
namespace {

class Buildings final : public Shortcut {
 public:
  Buildings()
      : Shortcut({"buildings_from_canopy.min_height",
                  "buildings_from_canopy.min_area",
                  "buildings_from_canopy.max_extent",
                  "buildings_from_canopy.roughness",
                  "buildings_from_canopy.min_confidence",
                  "buildings_from_canopy.min_wall",
                  "buildings_from_canopy.overhang",
                  "buildings_from_canopy.overhang_sd",
                  "buildings_from_canopy.survey_sd",
                  "poles_from_points.min_density",
                  "poles_from_points.min_pole_height",
                  "poles_from_points.max_width",
                  "poles_from_points.clearance",
                  "poles_from_points.min_returns",
                  "load_canopy.resolution",
                  "load_canopy.ground_square",
                  "load_canopy.crs",
                  "load_canopy.aoi",
                  "load_canopy.tile_cells",
                  "load_canopy.memory"}) {}

 private:
  CommandSpec describe_own() override {
    std::vector<Argument> all = canopy_arguments(files_);
    all.push_back({"--no-poles", "", &no_poles_, "Search no poles"});
    all.push_back({"--trees", "", &trees_, "Map the trees that are not on roofs, too"});
    return {
        .name = "buildings",
        .group = Group::make,
        .summary = "Find buildings, walls, corners and poles in airborne laser points",
        .about =
            "Roofs are connected planes of last returns; trees are rough, and pulses pass them. Edges are "
            "fitted by straight walls along two perpendicular directions, others where the edge requires "
            "them. The map has a point per building (height, diameter, orientation), a layer `footprint` of "
            "polygons, and walls and corners, as `waymark import --rules osm` makes them of polygons: a "
            "robot in the street can be localized by them. Poles need laser points of some density; where "
            "it is less, a warning says so. The map does not depend on --threads or --tile-cells.",
        .arguments = all,
        .examples = {
            {"waymark buildings --las tiles/ -o town.gpkg", "From laser points"},
            {"waymark buildings --las tiles/ --dtm official_dtm.tif -o town.gpkg",
             "Heights above a terrain model"},
            {"waymark buildings --dsm dsm.tif --dtm dtm.tif -o town.gpkg", "Surface less terrain"},
            {"waymark buildings --las tiles/ -o town.gpkg --overhang 0.4", "Eaves 0.4 m beyond the walls"},
            {"waymark buildings --las tiles/ -o town.gpkg --trees", "Trees between the houses as well"}}};
  }

  void add_stages(pipeline::Pipeline& pipeline) const override {
    workflows::add_building_stages(pipeline, files_, {.poles = !no_poles_, .trees = trees_});
  }

  workflows::CanopyFiles files_;
  bool no_poles_ = false, trees_ = false;
};

}  // namespace

void register_command_buildings(CommandTable& commands);
void register_command_buildings(CommandTable& commands) {
  commands.add<Buildings>();
}

}  // namespace waymark::apps

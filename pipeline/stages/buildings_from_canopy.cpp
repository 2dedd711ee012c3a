// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/building_landmarks.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
#include "pipeline/stages/one_survey.hpp"

namespace waymark::pipeline {
namespace {

struct BuildingsFromCanopy {
  struct Options {
    RoofRules roofs;
    WallRules walls;
    Meters min_height{2.5}, max_extent{150}, roughness{0.15}, min_wall{2}, overhang{0}, overhang_sd{0.3},
        survey_sd{0.1};

    void describe(OptionVisitor& option) {
      option("min_height", min_height, {.help = "Lowest roof above the ground", .min = 1, .max = 50});
      option("min_area", roofs.min_area, {.help = "Smallest footprint kept, m2", .min = 4, .max = 1e5});
      option("max_extent", max_extent,
             {.help = "Widest connected group of roofs; wider ones are rejected. Tiles read this far around",
              .min = 20,
              .max = 2000});
      option("roughness", roughness,
             {.help = "Root mean square distance of returns from the plane of their roof; more is vegetation",
              .min = 0.02,
              .max = 1});
      option("min_confidence", roofs.min_confidence,
             {.help = "Roofs less probable than this are rejected", .min = 0, .max = 1});
      option("min_wall", min_wall, {.help = "Shortest wall kept as a landmark", .min = 0.5, .max = 100});
      option("overhang", overhang,
             {.help = "Distance of the eaves from the walls: walls and corners are moved in by it",
              .min = 0,
              .max = 3});
      option("overhang_sd", overhang_sd,
             {.help = "Standard deviation of the overhang, part of that of walls and corners",
              .min = 0,
              .max = 3});
      option("survey_sd", survey_sd,
             {.help = "Horizontal standard deviation of the survey as a whole", .min = 0, .max = 10});
    }
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};
  static constexpr Out<std::vector<BuildingOutline>> footprints{"footprints"};

  static StageSpec spec() {
    return {.name = "buildings_from_canopy",
            .summary = "Finds roofs in laser points or a surface model: buildings, their walls and corners",
            .version = 1,
            .scope = Scope::tile,
            .inputs = {canopies},
            .outputs = {landmarks, evidence, footprints},
            .finds = {"building", "wall", "wall_corner"}};
  }

  static void check_inputs(const Options&, StageContext& unit) {
    if (unit.has(canopies)) require_one_survey(unit.read(canopies), "buildings_from_canopy");
  }

  static void run(const Options& options, StageContext& unit) {
    const CanopySource& canopy = *unit.read(canopies).at(0);
    RoofRules roofs = options.roofs;
    roofs.min_height = options.min_height.value, roofs.max_extent = options.max_extent.value;
    roofs.roughness = options.roughness.value;
    const WallRules walls{.overhang = options.overhang.value,
                          .overhang_sd = options.overhang_sd.value,
                          .survey_sd = options.survey_sd.value,
                          .min_length = options.min_wall.value};
    const Window owned = tile_window(canopy.geometry(), canopy.geometry(), unit.tile().cells);
    FoundBuildings found = find_buildings(canopy, owned, roofs);
    std::erase_if(found.buildings,
                  [&](const DetectedBuilding& b) { return !owned.contains(b.first_column, b.first_row); });
    std::int64_t rejected = 0;
    for (const auto& [reason, count] : found.rejected) unit.reject(reason, count), rejected += count;
    const Georeference& where = canopy.geometry().where;
    const auto outside = std::erase_if(found.buildings, [&](const DetectedBuilding& b) {
      Eigen::Vector2d at = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& v : b.outline.outer.vertices)
        at += v / (static_cast<double>(b.outline.outer.vertices.size()) * where.crs.metres_per_unit());
      return !canopy.in_area(where.x0 + at.x(), where.y0 + at.y());
    });
    if (outside > 0) unit.reject(kOutsideArea, static_cast<std::int64_t>(outside));
    unit.count_in(std::ssize(found.buildings) + rejected + static_cast<std::int64_t>(outside));
    unit.count_out(std::ssize(found.buildings));
    BuildingLandmarks made = building_landmarks(found.buildings, canopy, unit.types(), walls);
    unit.write(landmarks, std::move(made.landmarks));
    unit.write(evidence, std::move(made.evidence));
    unit.write(footprints, std::move(made.footprints));
  }
};

}  // namespace

void register_stage_buildings_from_canopy(Registry& registry);
void register_stage_buildings_from_canopy(Registry& registry) {
  registry.add<BuildingsFromCanopy>();
}

}  // namespace waymark::pipeline

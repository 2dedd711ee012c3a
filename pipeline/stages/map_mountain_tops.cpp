// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stages/mountain_tops_stage.hpp"

namespace waymark::pipeline {
namespace {

struct MapMountainTops : MountainTopsStage {
  static StageSpec spec() {
    return MountainTopsStage::spec("map_mountain_tops",
                                   "Converts summits to landmarks: position, features, visibility, parents",
                                   2, Scope::map);
  }
  static void run(const Options& options, StageContext& unit) {
    const GridGeometry& grid = unit.read(dem)->geometry();
    write_landmarks(options, {0, 0, grid.columns, grid.rows}, unit);
  }
};

}  // namespace

void register_stage_map_mountain_tops(Registry& registry);
void register_stage_map_mountain_tops(Registry& registry) {
  registry.add<MapMountainTops>();
}

}  // namespace waymark::pipeline

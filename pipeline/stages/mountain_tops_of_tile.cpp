// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stages/mountain_tops_stage.hpp"

namespace waymark::pipeline {
namespace {

// Equivalent of map_mountain_tops, tile by tile, so that not all landmarks are in memory.
struct MountainTopsOfTile : MountainTopsStage {
  static StageSpec spec() {
    return MountainTopsStage::spec("mountain_tops_of_tile",
                                   "Converts the summits of a tile to landmarks, as map_mountain_tops does",
                                   1, Scope::tile);
  }
  static void run(const Options& options, StageContext& unit) {
    write_landmarks(options, unit.tile().cells, unit);
  }
};

}  // namespace

void register_stage_mountain_tops_of_tile(Registry& registry);
void register_stage_mountain_tops_of_tile(Registry& registry) {
  registry.add<MountainTopsOfTile>();
}

}  // namespace waymark::pipeline

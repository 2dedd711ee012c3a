// SPDX-License-Identifier: Apache-2.0
#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/terrain/codecs.hpp"
#include "pipeline/terrain/hidden_ground.hpp"

namespace waymark::pipeline {
namespace {

struct FindMountainTops {
  struct Options {
    Meters min_prominence{20};
    void describe(OptionVisitor& option) {
      option("min_prominence", min_prominence,
             {.help = "Smallest prominence of a summit that is kept; 0 keeps all", .min = 0, .max = 40000});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Out<DivideTree> divide_tree{"divide_tree"};
  static constexpr Out<BlockRelief> block_relief_out{"block_relief"};

  static StageSpec spec() {
    return {.name = "find_mountain_tops",
            .summary = "Finds the summits and saddles of a tile",
            .version = 2,
            .scope = Scope::tile,
            .halo = 1,
            .inputs = {dem},
            .outputs = {divide_tree, block_relief_out}};
  }

  static void run(const Options& options, StageContext& unit) {
    const DemSource& source = *unit.read(dem);
    const HeightWindow heights = source.read(unit.cells_with_halo());
    unit.progress(0.5);
    const double hidden = hidden_above(source);
    unit.write(block_relief_out, block_relief(heights, unit.tile().cells, hidden));
    auto tree = build_divide_tree(heights, unit.tile().cells, source.geometry(),
                                  {.min_prominence = options.min_prominence.value, .hidden_above = hidden});
    tree.voids.faults = source.faults(unit.tile().cells);
    unit.count_out(tree.maxima);  // a source: its input is cells
    unit.write(divide_tree, std::move(tree));
  }
};

}  // namespace

void register_stage_find_mountain_tops(Registry& registry);
void register_stage_find_mountain_tops(Registry& registry) {
  registry.add<FindMountainTops>();
}

}  // namespace waymark::pipeline

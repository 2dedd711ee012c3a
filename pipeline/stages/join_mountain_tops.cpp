// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/terrain/codecs.hpp"

namespace waymark {
namespace {

struct JoinMountainTops {
  struct Options {
    std::string base = "auto";
    void describe(OptionVisitor& option) {
      option("base", base,
             {.help = "What the highest summit of each piece of land is measured from: elevation 0, the "
                      "lowest cell, or "
                      "nothing; auto: 0 where the highest cell lies above it",
              .choices = {"auto", "sea", "lowest", "none"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<DivideTree> divide_tree{"divide_tree"};
  static constexpr In<BlockRelief> block_relief_in{"block_relief"};
  static constexpr Out<std::vector<Summit>> summits{"summits"};
  static constexpr Out<ReliefPyramid> relief{"relief"};

  static StageSpec spec() {
    return {.name = "join_mountain_tops",
            .summary = "Joins the tiles: exact prominence, key saddle and parent of each summit",
            .version = 1,
            .scope = Scope::map,
            .inputs = {dem, divide_tree, block_relief_in},
            .outputs = {summits, relief}};
  }

  static BasePolicy policy(const std::string& base) {
    static const std::map<std::string, BasePolicy> policies{{"auto", BasePolicy::automatic},
                                                            {"sea", BasePolicy::sea},
                                                            {"lowest", BasePolicy::lowest},
                                                            {"none", BasePolicy::none}};
    return policies.at(base);
  }

  static void run(const Options& options, StageContext& unit) {
    const GridGeometry& grid = unit.read(dem)->geometry();
    const auto trees = unit.read_all(divide_tree);
    double min_prominence = 0, highest = kNoHeight;
    std::int64_t maxima = 0;
    for (const auto& tree : trees) {
      min_prominence = tree->min_prominence;
      maxima += tree->maxima;
      if (tree->cells) highest = std::max(highest, tree->highest);
    }
    auto found = join_divide_trees(trees, min_prominence, policy(options.base));
    if (options.base == "sea" && highest <= 0)
      unit.warn(
          "the highest ground lies below elevation 0, so its summit has no prominence over the sea and is "
          "left "
          "out; base = lowest measures it from the lowest cell");
    unit.count_in(maxima);
    unit.count_out(static_cast<std::int64_t>(found.size()));
    unit.reject(min_prominence > 0 ? "prominence too small" : "no prominence: part of higher ground",
                maxima - static_cast<std::int64_t>(found.size()));
    unit.write(summits, std::move(found));
    unit.write(relief, ReliefPyramid(unit.read_all(block_relief_in), grid.columns, grid.rows));
  }
};

}  // namespace

void register_stage_join_mountain_tops(Registry& registry);
void register_stage_join_mountain_tops(Registry& registry) {
  registry.add<JoinMountainTops>();
}

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geo/dem_handle.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/terrain/codecs.hpp"
#include "pipeline/terrain/merge_trees.hpp"

namespace waymark::pipeline {
namespace {

struct JoinMountainTops {
  struct Options {
    std::string base = "auto";
    void describe(OptionVisitor& option) {
      option("base", base,
             {.help = "Reference of the highest summit of each land mass: elevation 0 (sea), the lowest "
                      "cell, or none; auto: sea if the highest cell lies above 0",
              .choices = {"auto", "sea", "lowest", "none"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Stream<DivideTree> divide_tree{"divide_tree"};
  static constexpr Stream<BlockRelief> block_relief_in{"block_relief"};
  static constexpr Out<std::vector<Summit>> summits{"summits"};
  static constexpr Out<ReliefPyramid> relief{"relief"};

  static StageSpec spec() {
    return {.name = "join_mountain_tops",
            .summary = "Joins the tiles: exact prominence, key saddle and parent of each summit",
            .version = 3,
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

  /// Reports cells without height: their share, what became of them, and what they do to the summits.
  static void warn_of_voids(const DivideTree::Voids& all, const DemSource& source,
                            const std::vector<Summit>& found, StageContext& unit) {
    const GridGeometry& grid = source.geometry();
    if (all.faults.implausible > 0)
      unit.warn(fmt::format(
          "{} cells hold numbers that no body's terrain reaches, e.g. {:.6g} m at ({:.10g}, "
          "{:.10g}); they count as cells without height: check the unit and the no-data value "
          "with gdalinfo",
          all.faults.implausible, all.faults.height, grid.where.x(static_cast<double>(all.faults.column)),
          grid.where.y(static_cast<double>(all.faults.row))));
    const auto percent = [&](std::int64_t cells) {
      const double part = 100 * static_cast<double>(cells) / static_cast<double>(grid.cells());
      return cells > 0 && part < 0.1 ? "under 0.1" : fmt::format("{}", std::round(10 * part) / 10);
    };
    if (all.faults.filled + all.empty > 0 && source.nodata_policy() == NodataPolicy::fill)
      unit.warn(
          fmt::format("{} cells without height ({} %) were interpolated; {} ({} %) are too far from "
                      "data and stay unknown (fill_distance)",
                      all.faults.filled, percent(all.faults.filled), all.empty, percent(all.empty)));
    if (all.rim == 0 || found.empty()) return;
    const auto bounded =
        std::ranges::count_if(found, [](const Summit& s) { return s.prominence_low < s.prominence; });
    std::string text = fmt::format(
        "{} % of the cells have no height, and {} cells{} lie beside them: {} of {} summits may be less "
        "prominent than measured and are ranked by their certified bound (prominence_low)",
        percent(all.empty), all.rim,
        source.nodata_policy() == NodataPolicy::ocean ? " too high for a shore" : "", bounded, found.size());
    if (source.nodata_policy() == NodataPolicy::ocean)
      text += "; --nodata fill interpolates gaps, --nodata unknown keeps them as gaps";
    unit.warn(std::move(text));
  }

  static void run(const Options& options, StageContext& unit) {
    const GridGeometry& grid = unit.read(dem)->geometry();
    TreePyramid tiles(grid);
    unit.visit(divide_tree, [&](std::shared_ptr<const DivideTree> tile) { tiles.add(std::move(tile)); });
    const std::shared_ptr<const DivideTree> trees[] = {tiles.whole()};
    const DivideTree& whole = *trees[0];
    auto found = join_divide_trees(trees, whole.min_prominence, policy(options.base));
    std::ranges::sort(found, {}, &Summit::cell);
    if (options.base == "sea" && (whole.cells == 0 || whole.highest <= 0))
      unit.warn(
          "the highest cell lies below elevation 0, so its summit has no prominence above the sea and is "
          "left out; base = lowest measures it from the lowest cell");
    warn_of_voids(whole.voids, *unit.read(dem), found, unit);
    unit.count_in(whole.maxima);
    unit.count_out(static_cast<std::int64_t>(found.size()));
    unit.reject(whole.min_prominence > 0 ? "prominence too small" : "no prominence: part of higher ground",
                whole.maxima - static_cast<std::int64_t>(found.size()));
    unit.write(summits, std::move(found));
    ReliefPyramid pyramid(grid.columns, grid.rows);
    unit.visit(block_relief_in, [&](const std::shared_ptr<const BlockRelief>& tile) { pyramid.add(*tile); });
    pyramid.build_levels();
    unit.write(relief, std::move(pyramid));
  }
};

}  // namespace

void register_stage_join_mountain_tops(Registry& registry);
void register_stage_join_mountain_tops(Registry& registry) {
  registry.add<JoinMountainTops>();
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "core/text_file.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/buildings/find_buildings.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/forest/tree_ground.hpp"
#include "pipeline/forest/tree_observations.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"

namespace waymark::pipeline {
namespace {

struct TreesFromCanopy {
  struct Options {
    std::string preset = "mixed", method = "peaks", allometry, species, roofs = "keep";
    Meters min_height{3};
    double isolation_base = -1, isolation_slope = -1, prominence = -1, smoothing = -1, max_crown_radius = -1;
    bool crowns = true;

    void describe(OptionVisitor& option) {
      option("preset", preset,
             {.help = "Parameters for a type of forest; see docs/methods/trees.md",
              .choices = forest_preset_names()});
      option("method", method,
             {.help = "peaks (smoothing, isolation, prominence) or lmf (variable-window local maxima, the "
                      "reference)",
              .choices = {"peaks", "lmf"}});
      option("min_height", min_height, {.help = "Lowest tree kept", .min = 0.5, .max = 100});
      option("isolation_base", isolation_base,
             {.help = "A treetop has no higher cell within isolation_base + isolation_slope x height, "
                      "metres; -1: as the preset",
              .min = -1,
              .max = 100});
      option("isolation_slope", isolation_slope,
             {.help = "See isolation_base; -1: as the preset", .min = -1, .max = 2});
      option(
          "prominence", prominence,
          {.help = "Smallest height of a treetop above its saddle to a higher one, metres; -1: as the preset",
           .min = -1,
           .max = 50});
      option(
          "smoothing", smoothing,
          {.help = "Standard deviation of the smoothing, metres; -1: as the preset", .min = -1, .max = 20});
      option("crowns", crowns, {.help = "Outline the crowns; without them trees have no crown diameter"});
      option("max_crown_radius", max_crown_radius,
             {.help = "Largest distance of a crown's edge from its top, metres; -1: as the preset",
              .min = -1,
              .max = 40});
      option(
          "allometry", allometry,
          {.help = "CSV table that gives stem diameters, as `waymark allometry fit` writes; empty: Jucker et "
                   "al. 2017"});
      option("species", species,
             {.help = "Row of the allometry table; empty: the type of forest (conifer, broadleaf, mixed), "
                      "else all"});
      option(
          "roofs", roofs,
          {.help =
               "remove: leave out tops on roofs, as `waymark buildings` finds them; keep: a canopy without "
               "houses needs no search",
           .choices = {"keep", "remove"}});
    }
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr Out<std::vector<Observation>> observations{"observations"};
  static constexpr Out<CrownTable> seen_crowns{"seen_crowns"};

  static StageSpec spec() {
    return {.name = "trees_from_canopy",
            .summary = "Finds treetops and crowns in canopy models; stem diameters by allometry",
            .version = 5,
            .scope = Scope::tile,
            .inputs = {canopies},
            .outputs = {observations, seen_crowns},
            .finds = {"tree"}};
  }

  static std::vector<std::string> input_files(const Options& o) {
    return o.allometry.empty() ? std::vector<std::string>{} : std::vector{o.allometry};
  }

  static TreetopRules apply_options(TreetopRules rules, const Options& o) {
    rules.min_height = o.min_height.value;
    if (o.isolation_base >= 0) rules.isolation_base = o.isolation_base;
    if (o.isolation_slope >= 0) rules.isolation_slope = o.isolation_slope;
    if (o.prominence >= 0) rules.prominence = o.prominence;
    return rules;
  }

  static ForestPreset configure(const ForestPreset& preset, const Options& o) {
    ForestPreset forest = o.method == "lmf" ? local_maxima_preset(preset) : preset;
    forest.tops = apply_options(forest.tops, o);
    if (o.smoothing >= 0) forest.smoothing = o.smoothing;
    if (o.max_crown_radius > 0) forest.crowns.max_radius = o.max_crown_radius;
    return forest;
  }

  static std::vector<Allometry> load_table(const Options& options, const StageContext& unit) {
    if (options.allometry.empty()) return built_in_allometry();
    const std::string path = unit.path(options.allometry);
    return parse_allometry(read_text(path, "the allometry table", ErrorCode::input,
                                     "`waymark allometry fit TREES.csv -o TABLE.csv` writes one"),
                           path);
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    const TypeId id = types.id("tree");
    const std::vector<Allometry> table = load_table(options, unit);
    TreeSearch search{.forest = configure(forest_preset(options.preset), options), .crowns = options.crowns};
    for (const ForestType type : {ForestType::conifer, ForestType::broadleaf, ForestType::mixed})
      search.by_type.push_back(configure(forest_preset(type), options).tops);
    const Canopies& surveys = unit.read(canopies);
    const GridGeometry common = common_grid(surveys);
    std::vector<Observation> seen;
    CrownTable outlines;
    for (const auto& canopy : surveys) {
      const Window owned = tile_window(canopy->geometry(), common, unit.tile().cells);
      const std::uint32_t survey = outlines.add_survey(*canopy);
      std::vector<DetectedTree> trees = find_trees(*canopy, owned, search);
      if (options.roofs == "remove") {
        unit.count_in(static_cast<std::int64_t>(trees.size()));
        unit.reject("top on a roof", remove_on_roofs(trees, *canopy, owned));
      }
      TreeShapes shapes;
      for (const DetectedTree& tree : trees) {
        if (options.crowns) shapes.add(tree.height, tree.crown_diameter);
        const std::string forest = forest_type(tree, *canopy, options);
        seen.push_back(observation_of(tree, *canopy, types[id], id, table,
                                      options.species.empty() ? forest : options.species,
                                      tree_errors(forest, options.allometry.empty())));
        if (options.crowns) outlines.add(survey, tree);
      }
      if (shapes.real_fraction() < 1)
        unit.warn(
            canopy->name() +
            ": many trees are too tall or too slender to stand; does it hold heights above ground, and not "
            "brightness or elevations?");
    }
    unit.count_out(static_cast<std::int64_t>(seen.size()));
    seen.shrink_to_fit();
    outlines.shrink_to_fit();
    unit.write(observations, std::move(seen));
    unit.write(seen_crowns, std::move(outlines));
  }

  /// Returns the number of trees removed.
  static std::int64_t remove_on_roofs(std::vector<DetectedTree>& trees, const CanopySource& canopy,
                                      const Window& owned) {
    constexpr double kEdge = 0.5;  // m: cells of the canopy model at the edge of a roof
    const FoundBuildings found = find_buildings(canopy, owned, {});
    const Georeference& where = canopy.geometry().where;
    const double unit = where.crs.metres_per_unit();
    return static_cast<std::int64_t>(std::erase_if(trees, [&](const DetectedTree& tree) {
      const Eigen::Vector2d at(static_cast<double>(tree.top.column) * where.dx * unit,
                               static_cast<double>(tree.top.row) * where.dy * unit);
      return std::ranges::any_of(found.buildings, [&](const DetectedBuilding& building) {
        return building.box.column - 2 <= tree.top.column &&
               tree.top.column < building.box.end_column() + 2 && building.box.row - 2 <= tree.top.row &&
               tree.top.row < building.box.end_row() + 2 && tree.height < building.height + 1 &&
               is_on(building, at, kEdge);
      });
    }));
  }

  static std::string forest_type(const DetectedTree& tree, const CanopySource& canopy,
                                 const Options& options) {
    const Grid<std::uint8_t> type = canopy.forest_types({tree.top.column, tree.top.row, 1, 1});
    const auto known = type.columns() ? static_cast<ForestType>(type(0, 0)) : ForestType::unknown;
    return known == ForestType::unknown ? options.preset : forest_preset(known).name;
  }
};

}  // namespace

void register_stage_trees_from_canopy(Registry& registry);
void register_stage_trees_from_canopy(Registry& registry) {
  registry.add<TreesFromCanopy>();
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "apps/output_path.hpp"
#include "apps/stand_figures.hpp"
#include "core/error.hpp"
#include "core/text_file.hpp"
#include "exporters/aside_folder.hpp"
#include "exporters/inventory_report.hpp"
#include "exporters/shape_csv.hpp"
#include "geodb/aside_file.hpp"
#include "importers/tables/stand_outlines.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

StandPolygon in_metres(const std::vector<ShapePart>& outline, double unit) {
  StandPolygon ground;
  const auto add = [&](const std::vector<Eigen::Vector2d>& ring) {
    auto& corners = ground.rings.emplace_back();
    for (const auto& corner : ring) corners.push_back(corner * unit);
    if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  };
  for (const ShapePart& part : outline) {
    add(part.outer);
    for (const auto& hole : part.holes) add(hole);
  }
  return ground;
}

class Inventory final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "inventory",
        .group = Group::use,
        .summary = "Count a map's trees by stand: stems, basal area, heights, volume, each with its error",
        .about =
            "Stands are the polygons of --stands, the cells of --grid, or the whole map. Per stand: stems, "
            "basal "
            "area, stem volume (and dry mass where the volume table tells it) per hectare, Lorey, dominant "
            "and "
            "mean height, quadratic and arithmetic mean diameter, cover, and the distribution of diameters, "
            "all "
            "with standard errors that come from the errors of the trees.\n\nA tree is counted where its "
            "stem "
            "stands. OUT.csv has a line per stand; OUT.gpkg is the map with the layers stand and stand_tree "
            "added. Stands in another CRS are transformed; stands that overlap are counted each by itself "
            "and "
            "told; stands without trees have none per hectare and no height. Exit code 3: some stands are no "
            "area.",
        .arguments =
            {file_word("MAP.gpkg", &map_, "Map with trees"),
             Argument{"-o,--output", "OUT", &output_, "OUT.csv, or OUT.gpkg; MAP.gpkg itself may be named"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--stands", "POLYGONS", &stands_, "Layer of polygons, in any CRS"}
                 .offering(Offer::file)
                 .or_else("the whole map"),
             Argument{"--stands-layer", "NAME", &stands_layer_, "Layer of a file that holds several"},
             Argument{"--grid", "METRES", &grid_, "Square cells of this side in place of stands"},
             Argument{"--allometry", "TABLE.csv", &allometry_,
                      "Stem diameters from this table (`waymark allometry fit`), by the stand's species"}
                 .offering(Offer::file)
                 .or_else("those of the map"),
             Argument{"--volume", "TABLE.csv", &volume_,
                      "Form factors by species: species,form_factor[,form_factor_sd,mass_per_volume]"}
                 .offering(Offer::file)
                 .or_else("0.47 +- 0.04 for all"),
             Argument{"--recall", "TABLE.csv", &recall_,
                      "Share of trees found by height: height_from,recall[,sd]; counts those nobody found"}
                 .offering(Offer::file)
                 .or_else("what was found is what is there"),
             Argument{"--trees-at-once", "N", &trees_at_once_,
                      "Trees held in memory, 1 kB each, unless one stand has more; no figure depends on it"}
                 .or_else("500000"),
             Argument{"--class-width", "CM", &class_width_, "Width of the diameter classes"}.or_else("5"),
             Argument{"--report", "FILE.html", &report_, "Write a report to print, with a map and histograms"}
                 .offering(Offer::file)},
        .examples = {
            {"waymark inventory trees.gpkg --stands stands.shp -o stands.csv", "A line per stand"},
            {"waymark inventory trees.gpkg --stands stands.geojson -o trees.gpkg --report stands.html",
             "Layers in the map, and a report"},
            {"waymark inventory trees.gpkg --grid 100 -o grid.gpkg", "Per cell of a hectare"}}};
  }

  int run(const Session&) override {
    check_request();
    const MapStore map = MapStore::open(map_);
    const TreeReader reader(map);
    if (reader.count() == 0) tell("the map has no trees: every figure is 0 or empty");
    const StandsInTurn stands(reader, stands_of(map, reader), trees_at_once_);
    const StandTables tables = read_tables();
    InventoryOptions options{.class_width = class_width_ / 100};
    if (!recall_.empty()) options.recall = parse_recall(read_text(recall_, "this table"), recall_);
    std::vector<StandResult> results;
    stands.visit([&](const MapTrees& trees, const NamedStand& stand) {
      results.push_back(figures_of(trees, stand, tables, options));
    });
    tell_weak(results);
    std::size_t counted = 0;
    for (const StandResult& stand : results) counted += static_cast<std::size_t>(stand.figures.trees);
    write(stand_layer(results), tree_layer(stands, tables), counted, map);
    say(fmt::format("{}: {} stands, {} trees\n", output_, results.size(), counted));
    for (const std::string& failure : failed_) log_error(failure + ": left out");
    return failed_.empty() ? 0 : 3;
  }

 private:
  void check_request() {
    const std::string kind = fs::path(output_).extension();
    if (kind == ".gpkg")
      check_map_output(output_);
    else if (kind != ".csv")
      throw Error(ErrorCode::usage, "the output is a .csv or a .gpkg", output_, "e.g. -o stands.csv");
    if (!stands_.empty() && grid_ != 0)
      throw Error(ErrorCode::usage, "--stands and --grid exclude each other", "", "give one of them");
    if (grid_ != 0 && !(grid_ >= 1 && grid_ <= 1e5))
      throw Error(ErrorCode::usage, fmt::format("--grid = {} is outside [1, 100000] m", grid_));
    if (trees_at_once_ < 1)
      throw Error(ErrorCode::usage, fmt::format("--trees-at-once = {} is below 1", trees_at_once_));
    if (!(class_width_ >= 0.5 && class_width_ <= 100))
      throw Error(ErrorCode::usage, fmt::format("--class-width = {} is outside [0.5, 100] cm", class_width_));
  }

  StandTables read_tables() const {
    StandTables tables;
    tables.diameters_file = allometry_;
    tables.volumes_file = volume_;
    if (!allometry_.empty())
      tables.diameters = parse_allometry(read_text(allometry_, "this table"), allometry_);
    if (!volume_.empty()) tables.volumes = parse_volume(read_text(volume_, "this table"), volume_);
    return tables;
  }

  void tell(const std::string& warning) {
    log_warning(warning);
    warnings_.push_back(warning);
  }

  std::vector<NamedStand> stands_of(const MapStore& map, const TreeReader& trees) {
    if (stands_.empty()) {
      NamedStand whole = whole_map(map, trees);
      if (grid_ == 0) return {whole};
      return cells_of(whole, trees.unit());
    }
    StandOutlines read = read_stand_outlines(stands_, stands_layer_, map.crs());
    for (const std::string& warning : read.warnings) tell(warning);
    failed_ = read.failed;
    std::vector<NamedStand> stands;
    for (StandOutline& outline : read.stands) {
      NamedStand stand{.name = outline.name, .species = outline.species, .ground = {}, .outline = {}};
      for (auto& rings : outline.polygons) {
        ShapePart part{.outer = rings[0]};
        part.holes.assign(rings.begin() + 1, rings.end());
        stand.outline.push_back(std::move(part));
      }
      stand.ground = in_metres(stand.outline, trees.unit());
      stands.push_back(std::move(stand));
    }
    return stands;
  }

  NamedStand whole_map(const MapStore& map, const TreeReader& trees) {
    NamedStand whole{.name = "all", .species = {}, .ground = {}, .outline = {}};
    for (const std::string& layer : shape_layers(map.path()))
      if (layer == "survey")
        for (const Shape& row : read_shape_layer(map.path(), layer).rows)
          whole.outline.insert(whole.outline.end(), row.parts.begin(), row.parts.end());
    whole.ground = in_metres(whole.outline, trees.unit());
    if (!whole.ground.rings.empty()) return whole;
    whole.ground = ground_of(trees.places());
    if (whole.ground.rings.empty())
      throw Error(ErrorCode::input, "the map's trees span no area: how large the stand is must be told", map_,
                  "give its ground: --stands POLYGONS");
    ShapePart part;
    for (const auto& corner : whole.ground.rings[0]) part.outer.push_back(corner / trees.unit());
    whole.outline = {part};
    tell(fmt::format(
        "the map does not tell what ground was surveyed: taken to be the hull of its trees, widened "
        "to {:.2f} ha; --stands tells it better",
        area(whole.ground) / 1e4));
    return whole;
  }

  /// Cells at whole multiples of their side, cut off where the ground ends.
  std::vector<NamedStand> cells_of(const NamedStand& whole, double unit) const {
    const Eigen::AlignedBox2d box = bounds(whole.ground);
    const auto first = [&](double low) { return static_cast<std::int64_t>(std::floor(low / grid_)); };
    const std::int64_t columns = first(box.max().x()) - first(box.min().x()) + 1,
                       rows = first(box.max().y()) - first(box.min().y()) + 1;
    if (columns * rows > 100'000)
      throw Error(ErrorCode::usage, fmt::format("the grid would have {} x {} cells", columns, rows), "",
                  "widen the cells: --grid METRES");
    std::vector<NamedStand> cells;
    for (std::int64_t j = rows - 1; j >= 0; --j)
      for (std::int64_t i = 0; i < columns; ++i) {
        const double x = static_cast<double>(first(box.min().x()) + i) * grid_,
                     y = static_cast<double>(first(box.min().y()) + j) * grid_;
        const StandPolygon part =
            clipped(whole.ground, {Eigen::Vector2d(x, y), Eigen::Vector2d(x + grid_, y + grid_)});
        if (!(area(part) > 1)) continue;
        NamedStand cell{
            .name = fmt::format("{:.0f}_{:.0f}", x, y), .species = {}, .ground = part, .outline = {}};
        for (const auto& ring : part.rings) {
          std::vector<Eigen::Vector2d> corners;
          for (const auto& corner : ring) corners.push_back(corner / unit);
          if (cell.outline.empty())
            cell.outline.push_back({.outer = std::move(corners)});
          else
            cell.outline[0].holes.push_back(std::move(corners));
        }
        cells.push_back(std::move(cell));
      }
    return cells;
  }

  void tell_weak(const std::vector<StandResult>& results) {
    int told = 0;
    for (const StandResult& r : results) {
      if (!stands_.empty() && r.figures.trees == 0 && ++told <= 20)
        tell(fmt::format("stand {} has no trees", r.stand.name));
      if (r.figures.without_diameter > 0 && ++told <= 20)
        tell(fmt::format("stand {}: {} of {} trees have no diameter, so basal area and volume lack them",
                         r.stand.name, r.figures.without_diameter, r.figures.trees));
    }
    if (told > 20) tell(fmt::format("{} more warnings of this kind", told - 20));
  }

  /// With every n-th of its rows, for a picture.
  static ShapeLayer thinned(ShapeLayer layer, std::size_t every) {
    std::size_t row = 0;
    layer.more([&](const Shape& shape) {
      if (row++ % every == 0) layer.rows.push_back(shape);
    });
    layer.more = {};
    return layer;
  }

  void write(const ShapeLayer& stands, const ShapeLayer& trees, std::size_t tree_count,
             const MapStore& map) const {
    if (fs::path(output_).extension() == ".csv") {
      write_file(output_, as_csv(stands));
    } else {
      const std::vector layers{stands, trees};
      std::error_code other;
      if (fs::equivalent(map_, output_, other)) {
        write_layers(output_, layers);
      } else {
        AsideFile copy(output_);
        fs::copy_file(map_, copy.path(), fs::copy_options::overwrite_existing);
        write_layers(copy.path(), layers, MapFile::own);
        copy.keep();
      }
    }
    const std::size_t every = 1 + tree_count / InventoryPage::kMostTrees;
    if (!report_.empty())
      write_inventory_report(report_, {.title = fs::path(map_).filename().string(),
                                       .crs = map.crs().id(),
                                       .stands = stands,
                                       .trees = thinned(trees, every),
                                       .tree_count = tree_count,
                                       .warnings = warnings_,
                                       .failed = failed_});
  }

  std::string map_, output_, stands_, stands_layer_, allometry_, volume_, recall_, report_;
  double grid_ = 0, class_width_ = 5;
  std::int64_t trees_at_once_ = 500'000;
  std::vector<std::string> warnings_, failed_;
};

}  // namespace

void register_command_inventory(CommandTable& commands);
void register_command_inventory(CommandTable& commands) {
  commands.add<Inventory>();
}

}  // namespace waymark

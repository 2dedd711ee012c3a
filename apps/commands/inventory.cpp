// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "apps/log.hpp"
#include "core/options/option_reader.hpp"
#include "exporters/vector/shape_json.hpp"
#include "workflows/forest/inventory.hpp"
#include "workflows/forest/stand_figures.hpp"

namespace waymark::apps {
namespace {

constexpr std::int64_t kNotGiven = -1;

class Inventory final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "inventory",
        .group = Group::use,
        .summary = "Count a map's trees by stand: stems, basal area, heights, volume, each with its error",
        .about =
            "Stands are the polygons of --stands, the cells of --grid, or the whole map. Per stand: "
            "stems, basal area, stem volume (and dry mass if the volume table has it) per hectare, Lorey, "
            "dominant and mean height, quadratic and arithmetic mean diameter, cover, and the "
            "distribution of diameters, all with standard errors derived from the errors of the trees.\n\n"
            "A tree is counted where its stem stands. OUT.csv has a line per stand; OUT.gpkg is the map "
            "with the layers stand and stand_tree added. Stands in another CRS are transformed. "
            "Overlapping stands are counted separately, with a warning. Stands without trees have zero "
            "per hectare and no height. Exit code 3: some stands have no area.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map with trees"),
             Argument{"-o,--output", "OUT", &request_.output,
                      "OUT.csv, or OUT.gpkg; MAP.gpkg itself may be named"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--stands", "POLYGONS", &request_.stands, "Layer of polygons, in any CRS"}
                 .offering(Offer::file)
                 .or_else("the whole map"),
             Argument{"--stands-layer", "NAME", &request_.stands_layer, "Layer of a file that holds several"},
             Argument{"--grid", "METRES", &request_.grid, "Square cells of this side in place of stands"},
             Argument{"--aoi", "POLYGONS", &request_.aoi,
                      "Area of interest, in any CRS: its polygons are the stands"}
                 .offering(Offer::file),
             Argument{"--allometry", "TABLE.csv", &request_.allometry,
                      "Stem diameters from this table (`waymark allometry fit`), by the stand's species"}
                 .offering(Offer::file)
                 .or_else("those of the map"),
             Argument{"--volume", "TABLE.csv", &request_.volume,
                      "Form factors by species: species,form_factor[,form_factor_sd,mass_per_volume]"}
                 .offering(Offer::file)
                 .or_else("0.47 +- 0.04 for all"),
             Argument{"--recall", "TABLE.csv", &request_.recall,
                      "Fraction of trees detected by height: height_from,recall[,sd]; corrects for "
                      "undetected trees"}
                 .offering(Offer::file)
                 .or_else("that of simulated forests for maps from the air; else all trees were detected"),
             Argument{"--memory", "MEGABYTES", &memory_.megabytes,
                      "Memory for trees, 1 kB each, unless one stand has more; no figure depends on it"}
                 .or_else(std::to_string(MemoryOption{}.megabytes)),
             Argument{"--trees-at-once", "N", &trees_at_once_,
                      "Replaced by --memory; 1000 trees take a megabyte"},
             Argument{"--class-width", "CM", &request_.class_width, "Width of the diameter classes"}.or_else(
                 "5"),
             Argument{"--report", "FILE.html", &request_.report,
                      "Write a report to print, with a map and histograms"}
                 .offering(Offer::file),
             format_option(&format_)},
        .examples = {
            {"waymark inventory trees.gpkg --stands stands.shp -o stands.csv", "A line per stand"},
            {"waymark inventory trees.gpkg --stands stands.geojson -o trees.gpkg --report stands.html",
             "Layers in the map, and a report"},
            {"waymark inventory trees.gpkg --stands stands.shp -o stands.csv --format json",
             "The same table as an array of objects on standard output"},
            {"waymark inventory trees.gpkg --grid 100 -o grid.gpkg", "Per cell of a hectare"}}};
  }

  int run(const Session& session) override {
    set_memory();
    const workflows::InventoryResult result = workflows::inventory(request_, console_callbacks(session));
    if (format_ == "json") std::cout << exporters::layer_to_json(workflows::stand_layer(result.stands));
    log_summary(
        fmt::format("{}: {} stands, {} trees\n", request_.output, result.stands.size(), result.trees));
    for (const std::string& failure : result.failed) log_error(failure + ": left out");
    return result.failed.empty() ? 0 : 3;
  }

 private:
  void set_memory() {
    if (trees_at_once_ != kNotGiven) {
      log_warning("--trees-at-once was replaced: use --memory, a megabyte for 1000 trees");
      request_.max_trees = trees_at_once_;
      return;
    }
    check_options([this](OptionVisitor& option) { memory_.describe(option); },
                  {.owner = "inventory", .prefix = "--"});
    request_.max_trees = workflows::trees_in_memory(memory_);
  }

  workflows::InventoryRequest request_;
  std::string format_ = "text";
  MemoryOption memory_;
  std::int64_t trees_at_once_ = kNotGiven;
};

}  // namespace

void register_command_inventory(CommandTable& commands);
void register_command_inventory(CommandTable& commands) {
  commands.add<Inventory>();
}

}  // namespace waymark::apps

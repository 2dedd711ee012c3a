// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem_codec.hpp"
#include "importers/tables/place_names.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::importers {
namespace {

struct LoadNames {
  struct Options {
    std::vector<std::string> files;
    std::string layer, name_column;
    Meters max_distance{300};

    void describe(OptionVisitor& option) {
      option("files", files, {.help = "Gazetteers: layers of named points"});
      option("layer", layer, {.help = "Layer of files that hold several"});
      option("name_column", name_column, {.help = "Column of the names; empty: name, label or toponym"});
      option("max_distance", max_distance,
             {.help = "Largest distance between a landmark and the place whose name it gets",
              .min = 0,
              .max = 100000});
    }
  };
  static constexpr pipeline::In<DemHandle> dem{"dem"};
  static constexpr pipeline::Out<PlaceNames> place_names{"place_names"};

  static pipeline::StageSpec spec() {
    return {.name = "load_names",
            .summary = "Reads the names of summits from a gazetteer",
            .version = 1,
            .scope = pipeline::Scope::map,
            .inputs = {dem},
            .outputs = {place_names}};
  }

  static std::vector<std::string> input_files(const Options& options) { return options.files; }

  static void run(const Options& options, pipeline::StageContext& unit) {
    const Crs& crs = unit.read(dem)->geometry().where.crs;
    PlaceNames names{.places = {}, .max_distance = options.max_distance.value};
    for (const std::string& file : options.files)
      for (PlaceName& place : read_place_names(unit.path(file), options.layer, options.name_column, crs))
        names.places.push_back(std::move(place));
    if (names.places.empty()) unit.warn("the gazetteer has no named point in the CRS of the map");
    unit.count_out(static_cast<std::int64_t>(names.places.size()));
    unit.write(place_names, std::move(names));
  }
};

}  // namespace

void register_stage_load_names(pipeline::Registry& registry);
void register_stage_load_names(pipeline::Registry& registry) {
  registry.add<LoadNames>();
}

}  // namespace waymark::importers

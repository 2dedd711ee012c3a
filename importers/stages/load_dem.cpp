// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "importers/rasters/nodata_policy.hpp"
#include "importers/tiling.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark {
namespace {

constexpr std::int64_t kMegabyte = std::int64_t{1} << 20;

struct LoadDem {
  struct Options {
    std::vector<std::string> files;
    std::string nodata = to_string(NodataPolicy::ocean);
    std::string crs;
    Meters height_sd{0};
    bool metric = false;
    std::int64_t tile_cells = 512;
    std::int64_t memory = 512;

    void describe(OptionVisitor& option) {
      option(
          "files", files,
          {.help = "Rasters that make the DEM; where they overlap the first one counts. Distances from the "
                   "body's centre become elevations above its equatorial radius"});
      option(
          "nodata", nodata,
          {.help =
               "What cells without a height are: ocean (nothing hidden), unknown (ground of any height may "
               "be hidden), fill (interpolated)",
           .choices = nodata_policy_names()});
      option("crs", crs,
             {.help = "Coordinate reference system instead of the files' own; local: metres on no body"});
      option("height_sd", height_sd,
             {.help = "Standard deviation of a height; 0: not known", .min = 0, .max = 1000});
      option("metric", metric,
             {.help = "true: a DEM in degrees is laid on a plane in metres about its middle, as images need "
                      "it; jobs that load images ask for it themselves"});
      option("tile_cells", tile_cells,
             {.help = "Side of the squares the DEM is worked on in; the map does not depend on it",
              .min = 64,
              .max = 16384});
      option("memory", memory,
             {.help = "Megabytes of decoded DEM kept for neighbouring tiles",
              .min = 16,
              .max = 1e7,
              .affects_result = false});
    }
  };

  static constexpr Out<DemHandle> dem{"dem"};
  static constexpr Out<std::vector<Tile>> tiles{"tiles"};

  static StageSpec spec() {
    return {.name = "load_dem",
            .summary = "Opens elevation rasters as one grid and cuts it into tiles",
            .version = 3,
            .scope = Scope::map,
            .lists = Scope::tile,
            .outputs = {dem, tiles}};
  }

  static std::vector<std::string> input_files(const Options& options) { return options.files; }

  static void run(const Options& options, StageContext& unit) {
    DemImport import{.nodata = nodata_policy(options.nodata),
                     .crs = options.crs,
                     .memory_bytes = options.memory * kMegabyte,
                     .height_sd = options.height_sd.value,
                     .metric = options.metric};
    for (const std::string& file : options.files) import.files.push_back(unit.path(file));
    const auto opened = import_dem(import);
    for (const std::string& warning : opened->warnings()) unit.warn(warning);
    const GridGeometry& grid = opened->geometry();
    unit.write(dem, DemHandle(opened));
    unit.write(tiles, tiles_of(grid.columns, grid.rows, options.tile_cells));
  }
};

}  // namespace

void register_stage_load_dem(Registry& registry);
void register_stage_load_dem(Registry& registry) {
  registry.add<LoadDem>();
}

}  // namespace waymark

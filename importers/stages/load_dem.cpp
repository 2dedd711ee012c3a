// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "importers/rasters/nodata_policy.hpp"
#include "importers/tiling.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::importers {
namespace {

struct LoadDem {
  struct Options {
    DemImport import;
    std::string nodata = to_string(NodataPolicy::ocean);
    std::int64_t tile_cells = 512;
    std::int64_t memory = 0;

    void describe(OptionVisitor& option) {
      option("files", import.files,
             {.help = "Rasters of the DEM; where they overlap the first one has priority. Distances from the "
                      "body's centre become elevations above its equatorial radius"});
      option("nodata", nodata,
             {.help =
                  "Meaning of cells without a height: ocean (nothing hidden, but beside ground above 100 m), "
                  "unknown (terrain of any height may be hidden), fill (interpolated, then unknown)",
              .choices = nodata_policy_names()});
      option("crs", import.crs,
             {.help = "Coordinate reference system instead of the files' own; local: metres on no body"});
      option("height_sd", import.height_sd,
             {.help = "Standard deviation of a height; 0: not known", .min = 0, .max = 1000});
      option("band", import.band,
             {.help = "Band that holds the heights; 0: the only one", .min = 0, .max = 65536});
      option("height_unit", import.height_unit,
             {.help = "Unit of the heights instead of the band's: m, km, dm, cm, mm, ft, us-ft"});
      option("height_scale", import.height_scale,
             {.help = "Factor of all heights, e.g. 0.1 for decimetres", .min = 1e-6, .max = 1e6});
      option("fill_distance", import.fill_distance,
             {.help = "nodata fill: voids are filled up to this many cells from data; the rest stays unknown",
              .min = 1,
              .max = 1000});
      option(
          "aoi", import.area,
          {.help =
               "Polygons of the area of interest: landmarks outside are left out, but measured on the whole "
               "DEM"});
      option("metric", import.metric,
             {.help = "true: project a DEM in degrees to metres about its middle, as images need "
                      "it; jobs that load images set it themselves"});
      option("tile_cells", tile_cells,
             {.help = "Side of the tiles for processing; the map does not depend on it",
              .min = 64,
              .max = 16384});
      option("memory", memory,
             {.help = "Memory for decoded rasters, megabytes; 0: 512 for a DEM that fits, else 96 (up to 512 "
                      "where rows of tiles touch more)",
              .min = 0,
              .max = 1e7,
              .affects_result = false});
    }
  };

  static constexpr pipeline::Out<DemHandle> dem{"dem"};
  static constexpr pipeline::Out<std::vector<pipeline::Tile>> tiles{"tiles"};

  static pipeline::StageSpec spec() {
    return {.name = "load_dem",
            .summary = "Opens elevation rasters as one grid and cuts it into tiles",
            .version = 4,
            .scope = pipeline::Scope::map,
            .lists = pipeline::Scope::tile,
            .outputs = {dem, tiles}};
  }

  static std::vector<std::string> input_files(const Options& options) {
    std::vector<std::string> files = options.import.files;
    if (!options.import.area.empty()) files.push_back(options.import.area);
    return files;
  }

  static void run(const Options& options, pipeline::StageContext& unit) {
    DemImport import = options.import;
    import.nodata = nodata_policy(options.nodata);
    import.memory_bytes = options.memory << 20;
    for (std::string& file : import.files) file = unit.path(file);
    if (!import.area.empty()) import.area = unit.path(import.area);
    const auto opened = import_dem(import);
    for (const std::string& warning : opened->warnings()) unit.warn(warning);
    const GridGeometry& grid = opened->geometry();
    unit.write(dem, DemHandle(opened));
    std::vector<pipeline::Tile> all = tiles_of(grid.columns, grid.rows, options.tile_cells);
    if (opened->has_square_blocks()) rank_along_curve(all);
    unit.write(tiles, std::move(all));
  }
};

}  // namespace

void register_stage_load_dem(pipeline::Registry& registry);
void register_stage_load_dem(pipeline::Registry& registry) {
  registry.add<LoadDem>();
}

}  // namespace waymark::importers

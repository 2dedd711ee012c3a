// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "core/options/memory_option.hpp"
#include "geo/plane_dem.hpp"
#include "importers/points/canopy.hpp"
#include "importers/points/canopy_codec.hpp"
#include "importers/rasters/dem_codec.hpp"
#include "importers/tiling.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::importers {
namespace {

struct LoadCanopy {
  struct Options {
    std::vector<std::string> chm, dsm, dtm, las;
    Meters resolution{0}, ground_square{20};
    bool flights = false;
    std::string forest_type, crs, aoi;
    std::int64_t tile_cells = 1024;
    MemoryOption memory;

    void describe(OptionVisitor& option) {
      option("chm", chm, {.help = "Canopy height models: heights above ground"});
      option("dsm", dsm, {.help = "Surface models, instead of chm; dtm gives the terrain"});
      option("dtm", dtm,
             {.help = "Terrain models under the surface models or the laser points, on any grid"});
      option("las", las,
             {.help = "LAS, LAZ or COPC files, instead of chm: one catalogue of laser points, with "
                      "classified ground (class 2) or with dtm"});
      option("resolution", resolution,
             {.help = "Cell size of the canopy made from laser points; 0: by their density",
              .min = 0,
              .max = 20});
      option(
          "ground_square", ground_square,
          {.help = "Side of the squares whose lowest points begin the ground where none is classified: wider "
                   "than the widest roof or crown",
           .min = 5,
           .max = 500});
      option(
          "flights", flights,
          {.help =
               "Each file of chm (of dsm, of las) is a separate survey: trees found in several are merged. "
               "Otherwise the files make one canopy; where they overlap the first one has priority"});
      option("forest_type", forest_type,
             {.help = "Raster of forest types, which select the preset for finding treetops: "
                      "1 conifer, 2 broadleaf, 3 mixed"});
      option("crs", crs,
             {.help = "Coordinate reference system instead of the files' own; local: metres on no body"});
      option(
          "aoi", aoi,
          {.help =
               "Polygons of the area of interest: trees outside are left out, but those inside are found in "
               "the whole canopy"});
      option("tile_cells", tile_cells,
             {.help = "Side of the tiles for processing; the trees do not depend on it",
              .min = 64,
              .max = 16384});
      memory.describe(option);
    }
  };

  static constexpr pipeline::Out<DemHandle> dem{"dem"};
  static constexpr pipeline::Out<Canopies> canopies{"canopies"};
  static constexpr pipeline::Out<std::vector<pipeline::Tile>> tiles{"tiles"};

  static pipeline::StageSpec spec() {
    return {.name = "load_canopy",
            .summary = "Opens canopy height models, or surface and terrain models, and cuts them into tiles",
            .version = 4,
            .scope = pipeline::Scope::map,
            .lists = pipeline::Scope::tile,
            .outputs = {dem, canopies, tiles}};
  }

  static std::vector<std::string> input_files(const Options& o) {
    std::vector<std::string> all;
    for (const auto* files : {&o.chm, &o.dsm, &o.dtm, &o.las})
      all.insert(all.end(), files->begin(), files->end());
    if (!o.forest_type.empty()) all.push_back(o.forest_type);
    if (!o.aoi.empty()) all.push_back(o.aoi);
    return all;
  }

  static void run(const Options& options, pipeline::StageContext& unit) {
    const auto resolved = [&](std::vector<std::string> files) {
      for (std::string& file : files) file = unit.path(file);
      return files;
    };
    CanopyImport all{.chm = resolved(options.chm),
                     .dsm = resolved(options.dsm),
                     .dtm = resolved(options.dtm),
                     .las = resolved(options.las),
                     .resolution = options.resolution.value,
                     .forest_type = options.forest_type.empty() ? "" : unit.path(options.forest_type),
                     .crs = options.crs,
                     .area = options.aoi.empty() ? "" : unit.path(options.aoi),
                     .memory_bytes = options.memory.bytes()};
    all.ground_square = options.ground_square.value;
    check(options);
    const std::vector<CanopyImport> surveys = options.flights ? open_each(all) : std::vector{all};
    Canopies opened;
    DemHandle terrain;
    for (const CanopyImport& survey : surveys) {
      const auto canopy = import_canopy(survey);
      for (const std::string& warning : canopy->warnings()) unit.warn(warning);
      const Crs& crs = canopy->geometry().where.crs;
      if (!opened.empty() && !crs.same_as(opened[0]->geometry().where.crs))
        throw Error(ErrorCode::input,
                    "surveys in different coordinate reference systems: " +
                        opened[0]->geometry().where.crs.id() + " and " + crs.id(),
                    canopy->name(), "reproject them into one first: gdalwarp -t_srs");
      if (!terrain) terrain = canopy->terrain();
      opened.push_back(canopy);
    }
    const GridGeometry grid = common_grid(opened);
    if (!all.area.empty())
      check_area_meets(read_area_of_interest(all.area, grid.where.crs), grid, "the canopy", all.area);
    unit.write(dem, terrain ? terrain : DemHandle(std::make_shared<PlaneDem>(grid.where.crs, 0, 0)));
    unit.write(tiles, tiles_of(grid.columns, grid.rows, options.tile_cells));
    unit.write(canopies, std::move(opened));
  }

  static void check(const Options& o) {
    if (!o.las.empty() && !(o.chm.empty() && o.dsm.empty()))
      throw Error(ErrorCode::usage, "laser points and rasters of a canopy are given", "load_canopy.las",
                  "points make their own canopy model: leave out one or the other; a terrain model (dtm) may "
                  "be given with points");
  }

  // Includes the folder if another file has the same name: names identify surveys.
  static std::string name_among(const std::string& file, const std::vector<std::string>& files) {
    const auto plain = [](const std::string& f) { return std::filesystem::path(f).filename(); };
    const auto alike =
        std::ranges::count_if(files, [&](const std::string& f) { return plain(f) == plain(file); });
    return alike > 1 ? file : plain(file).string();
  }

  // Surface models share the terrain models.
  static std::vector<CanopyImport> open_each(const CanopyImport& all) {
    std::vector<CanopyImport> surveys;
    const auto count = static_cast<std::int64_t>(all.chm.size() + all.dsm.size() + all.las.size());
    for (auto member : {&CanopyImport::chm, &CanopyImport::dsm, &CanopyImport::las})
      for (const std::string& file : all.*member) {
        surveys.push_back(all);
        surveys.back().*member = {file};
        surveys.back().name = name_among(file, all.*member);
        surveys.back().memory_bytes = all.memory_bytes / count;
      }
    return surveys.empty() ? std::vector{all} : surveys;
  }
};

}  // namespace

void register_stage_load_canopy(pipeline::Registry& registry);
void register_stage_load_canopy(pipeline::Registry& registry) {
  registry.add<LoadCanopy>();
}

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#include "geo/plane_dem.hpp"
#include "importers/canopy.hpp"
#include "importers/canopy_codec.hpp"
#include "importers/dem_codec.hpp"
#include "importers/tiling.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark {
namespace {

constexpr std::int64_t kMegabyte = std::int64_t{1} << 20;

struct LoadCanopy {
  struct Options {
    std::vector<std::string> chm, dsm, dtm;
    bool flights = false;
    std::string forest_type, crs;
    std::int64_t tile_cells = 1024;
    std::int64_t memory = 512;

    void describe(OptionVisitor& option) {
      option("chm", chm, {.help = "Canopy height models: heights above ground"});
      option("dsm", dsm, {.help = "Surface models, instead of chm; the ground is told by dtm"});
      option("dtm", dtm, {.help = "Terrain models under the surface models, on any grid"});
      option("flights", flights,
             {.help = "Each file of chm (or of dsm) is a survey of its own: trees that several saw are merged. "
                      "Otherwise the files make one canopy; where they overlap the first one counts"});
      option("forest_type", forest_type,
             {.help = "Raster that tells the type of forest, so that treetops are sought by the preset of each: "
                      "1 conifer, 2 broadleaf, 3 mixed"});
      option("crs", crs,
             {.help = "Coordinate reference system instead of the files' own; local: metres on no body"});
      option("tile_cells", tile_cells,
             {.help = "Side of the squares the canopy is worked on in; the trees do not depend on it",
              .min = 64,
              .max = 16384});
      option("memory", memory,
             {.help = "Megabytes of decoded rasters kept for neighbouring tiles",
              .min = 16,
              .max = 1e7,
              .affects_result = false});
    }
  };

  static constexpr Out<DemHandle> dem{"dem"};
  static constexpr Out<Canopies> canopies{"canopies"};
  static constexpr Out<std::vector<Tile>> tiles{"tiles"};

  static StageSpec spec() {
    return {.name = "load_canopy",
            .summary = "Opens canopy height models, or surface and terrain models, and cuts them into tiles",
            .version = 1,
            .scope = Scope::map,
            .lists = Scope::tile,
            .outputs = {dem, canopies, tiles}};
  }

  static std::vector<std::string> input_files(const Options& o) {
    std::vector<std::string> all;
    for (const auto* files : {&o.chm, &o.dsm, &o.dtm}) all.insert(all.end(), files->begin(), files->end());
    if (!o.forest_type.empty()) all.push_back(o.forest_type);
    return all;
  }

  static void run(const Options& options, StageContext& unit) {
    const auto resolved = [&](std::vector<std::string> files) {
      for (std::string& file : files) file = unit.path(file);
      return files;
    };
    CanopyImport all{.chm = resolved(options.chm),
                     .dsm = resolved(options.dsm),
                     .dtm = resolved(options.dtm),
                     .forest_type = options.forest_type.empty() ? "" : unit.path(options.forest_type),
                     .crs = options.crs,
                     .memory_bytes = options.memory * kMegabyte};
    std::vector<CanopyImport> surveys{all};
    if (options.flights && all.chm.size() + all.dsm.size() > 1) surveys = one_each(all);
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
    unit.write(dem, terrain ? terrain : DemHandle(std::make_shared<PlaneDem>(grid.where.crs, 0, 0)));
    unit.write(tiles, tiles_of(grid.columns, grid.rows, options.tile_cells));
    unit.write(canopies, std::move(opened));
  }

  // Surface models share the terrain models.
  static std::vector<CanopyImport> one_each(const CanopyImport& all) {
    std::vector<CanopyImport> surveys;
    for (const bool heights : {true, false})
      for (const std::string& file : heights ? all.chm : all.dsm) {
        CanopyImport one = all;
        (heights ? one.chm : one.dsm) = {file};
        one.memory_bytes = all.memory_bytes / static_cast<std::int64_t>(all.chm.size() + all.dsm.size());
        surveys.push_back(one);
      }
    return surveys;
  }
};

}  // namespace

void register_stage_load_canopy(Registry& registry);
void register_stage_load_canopy(Registry& registry) {
  registry.add<LoadCanopy>();
}

}  // namespace waymark

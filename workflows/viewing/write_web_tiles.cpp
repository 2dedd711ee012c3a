// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/write_web_tiles.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <span>

#include "exporters/web/thinning.hpp"
#include "pipeline/engine/progress_meter.hpp"

namespace waymark::workflows {
namespace {

using exporters::PmtilesFile;
using exporters::WebPlane;
using exporters::WebProjection;

/// Makes the contents of tiles on all threads and adds them to an archive in order.
class TileMaker {
 public:
  explicit TileMaker(const TileWriting& writing)
      : arena_(writing.threads > 0 ? writing.threads : tbb::task_arena::automatic),
        callbacks_(writing.callbacks) {}

  void operator()(PmtilesFile& file, const std::string& stage, std::size_t count,
                  const std::function<std::uint64_t(std::size_t)>& id,
                  const std::function<std::string(std::size_t)>& content) {
    const auto batch = static_cast<std::size_t>(16 * arena_.max_concurrency());
    pipeline::ProgressMeter meter(callbacks_.progress, stage, static_cast<std::int64_t>(count));
    for (std::size_t first = 0; first < count; first += batch) {
      std::vector<std::string> made(std::min(batch, count - first));
      arena_.execute([&] {
        tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t i) {
          made[i] = content(first + i);
          meter.add(1);
        });
      });
      for (std::size_t i = 0; i < made.size(); ++i) file.add(id(first + i), made[i]);
    }
    meter.finish();
  }

 private:
  tbb::task_arena arena_;
  const Callbacks& callbacks_;
};

exporters::PmtilesHeader header_of(const exporters::WebBounds& bounds, int max_zoom) {
  exporters::PmtilesHeader header{.max_zoom = max_zoom};
  const bool crosses_edge = bounds.west < 0 || bounds.east > 1;
  // Readers skip tiles that the bounds only touch, so landmarks on the edge of a tile need a margin.
  constexpr double margin = 1e-6;
  header.bounds = {crosses_edge ? -180 : exporters::web_longitude(bounds.west) - margin,
                   exporters::web_latitude(bounds.south) - margin,
                   crosses_edge ? 180 : exporters::web_longitude(bounds.east) + margin,
                   exporters::web_latitude(bounds.north) + margin};
  const double middle = (bounds.west + bounds.east) / 2;
  header.centre = {exporters::web_longitude(middle - std::floor(middle)),
                   exporters::web_latitude((bounds.north + bounds.south) / 2)};
  header.centre_zoom = max_zoom;
  return header;
}

}  // namespace

std::int64_t write_landmark_tiles(const TileWriting& writing, PmtilesFile& file,
                                  const exporters::WebLandmarks& all, const exporters::WebStyle& style,
                                  int max_zoom) {
  TileMaker make(writing);
  for (int zoom = 0; zoom <= max_zoom; ++zoom) {
    const auto shown =
        zoom < max_zoom ? exporters::thin_out(all.landmarks, zoom) : exporters::all_of(all.landmarks);
    const auto tiles = exporters::tiles_of(all.landmarks, shown, zoom);
    make(
        file, fmt::format("landmarks, zoom {}", zoom), tiles.size(),
        [&](std::size_t i) { return exporters::pmtiles_id(tiles[i].id); },
        [&](std::size_t i) {
          return exporters::landmark_tile(all, std::span(shown).subspan(tiles[i].first, tiles[i].count),
                                          zoom);
        });
  }
  exporters::PmtilesHeader header = header_of(style.bounds, max_zoom);
  header.metadata = exporters::landmark_metadata(all, style, max_zoom);
  file.finish(header);
  return static_cast<std::int64_t>(file.tile_count());
}

std::int64_t write_shape_tiles(const TileWriting& writing, PmtilesFile& file, const exporters::WebShapes& all,
                               const std::string& title, int top) {
  TileMaker make(writing);
  for (int zoom = 0; zoom <= top; ++zoom) {
    const auto tiles = exporters::shape_tiles(all, zoom, top);
    make(
        file, fmt::format("areas, zoom {}", zoom), tiles.size(),
        [&](std::size_t i) { return exporters::pmtiles_id(tiles[i].id); },
        [&](std::size_t i) { return exporters::shape_tile(all, tiles[i], top); });
  }
  exporters::PmtilesHeader header = header_of(exporters::bounds_of(all), top);
  header.metadata = exporters::shape_metadata(all, title, top);
  file.finish(header);
  return static_cast<std::int64_t>(file.tile_count());
}

std::int64_t write_terrain_tiles(const TileWriting& writing, PmtilesFile& file,
                                 const exporters::TerrainTiles& terrain, const Crs& crs, WebPlane plane) {
  TileMaker make(writing);
  const std::vector<exporters::TileId> tiles = terrain.tiles();
  tbb::enumerable_thread_specific<std::unique_ptr<WebProjection>> projections(
      [&] { return std::make_unique<WebProjection>(crs, plane); });
  make(
      file, "terrain", tiles.size(), [&](std::size_t i) { return exporters::pmtiles_id(tiles[i]); },
      [&](std::size_t i) { return terrain.tile(tiles[i], *projections.local()); });
  exporters::PmtilesHeader header = header_of(terrain.bounds(), terrain.max_zoom());
  header.tiles = exporters::PmtilesHeader::Tiles::png;
  header.gzipped = false;
  header.metadata = R"({"name":"terrain","encoding":"terrarium"})";
  file.finish(header);
  return static_cast<std::int64_t>(file.tile_count());
}

}  // namespace waymark::workflows

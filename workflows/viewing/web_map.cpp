// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/web_map.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <set>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "core/text_file.hpp"
#include "exporters/records/map_extent.hpp"
#include "exporters/report/map_drawing.hpp"
#include "exporters/web/pmtiles_file.hpp"
#include "exporters/web/terrain_tiles.hpp"
#include "exporters/web/thinning.hpp"
#include "exporters/web/web_page.hpp"
#include "exporters/web/web_style.hpp"
#include "geodb/map_store.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/engine/sha256.hpp"
#include "workflows/query/map_of_area.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using exporters::PmtilesFile;
using exporters::WebPlane;
using exporters::WebProjection;

/// Names that a web map has in its folder.
const std::set<std::string> kOwnNames{"index.html",      "site.js",        "site.css",
                                      "style.json",      "fetch-maplibre", "landmarks.pmtiles",
                                      "terrain.pmtiles", "shapes.pmtiles", "lib"};

void check_folder(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::output, "the output is a file, and a web map is a folder", folder.string(),
                "name a folder, e.g. -o site");
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!kOwnNames.contains(name) && !name.starts_with(kAsidePrefix))
      throw Error(ErrorCode::output, "the folder holds files that are no part of a web map, such as " + name,
                  folder.string(), "name a new or empty folder; the server's own files go beside it");
  }
}

/// Returns the pinned files of the map library from a folder.
std::map<std::string, std::string> read_library(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& [name, sha256] : exporters::web_library()) {
    std::string content = read_text(folder / name, "the map library");
    if (pipeline::sha256(content) != sha256)
      throw Error(ErrorCode::usage, fmt::format("{} is not the version that the page is made for", name),
                  (folder / name).string(), "fetch it with scripts/fetch-maplibre " + folder.string());
    files.emplace(name, std::move(content));
  }
  return files;
}

/// Makes the contents of tiles on all threads and adds them to an archive in order.
struct TileMaker {
  tbb::task_arena arena;
  const Callbacks& callbacks;

  void operator()(PmtilesFile& file, const std::string& stage, std::size_t count,
                  const std::function<std::uint64_t(std::size_t)>& id,
                  const std::function<std::string(std::size_t)>& content) {
    const auto batch = static_cast<std::size_t>(16 * arena.max_concurrency());
    pipeline::ProgressMeter meter(callbacks.progress, stage, static_cast<std::int64_t>(count));
    for (std::size_t first = 0; first < count; first += batch) {
      std::vector<std::string> made(std::min(batch, count - first));
      arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, made.size(), [&](std::size_t i) {
          made[i] = content(first + i);
          meter.add(1);
        });
      });
      for (std::size_t i = 0; i < made.size(); ++i) file.add(id(first + i), made[i]);
    }
    meter.finish();
  }
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

std::int64_t write_landmarks(TileMaker& make, PmtilesFile& file, const exporters::WebLandmarks& all,
                             const exporters::WebStyle& style, int max_zoom) {
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

std::int64_t write_shapes(TileMaker& make, PmtilesFile& file, const exporters::WebShapes& all,
                          const std::string& title, int top) {
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

std::int64_t write_terrain(TileMaker& make, PmtilesFile& file, const exporters::TerrainTiles& terrain,
                           const Crs& crs, WebPlane plane) {
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

/// Returns the terrain of a map at no more than the resolution of its files.
std::optional<exporters::Relief> read_terrain(const WebMapRequest& request, const geodb::MapStore& map,
                                              double near_x) {
  if (request.terrain_pixels <= 0) return std::nullopt;
  const auto names = request.dem.empty() ? exporters::relief_names(map) : request.dem;
  const auto pixels = exporters::relief_pixels(names, map.crs(), near_x, request.terrain_pixels);
  std::optional<exporters::Relief> relief;
  if (pixels > 0) relief = exporters::read_relief(names, map.crs(), near_x, pixels);
  const auto is_known = [](float height) { return !std::isnan(height); };
  if (relief && std::ranges::none_of(relief->heights.cells(), is_known)) relief.reset();
  if (!relief && !request.dem.empty())
    throw Error(ErrorCode::input, "no elevation model of this map's body and kind of CRS could be read",
                request.dem.front(), "gdalinfo shows what the file is; gdalwarp converts it");
  return relief;
}

double lowest_of(const exporters::Relief& relief) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const float height : relief.heights.cells())
    if (height < lowest) lowest = height;
  return lowest;
}

void write_texts(const fs::path& folder, const std::map<std::string, std::string>& files,
                 const fs::path& output) {
  for (const auto& [name, text] : files)
    if (const int failed = write_aside(folder / name, text)) fail_output(output / name, failed);
}

void check_request(const WebMapRequest& request) {
  if (request.max_zoom > exporters::kMaxWebZoom)
    throw Error(ErrorCode::usage, fmt::format("zoom {} is finer than any map tile", request.max_zoom),
                "--max-zoom", fmt::format("give 0 to {}", exporters::kMaxWebZoom));
  check_folder(request.output);
}

std::string size_text(const fs::path& file) {
  return fmt::format("{:.1f} MB", double(fs::file_size(file)) / 1e6);
}

WebMapResult make_web_map_of_area(const WebMapRequest& request, const Callbacks& callbacks) {
  const fs::path folder = (fs::path(request.output) / "").lexically_normal().parent_path();
  const MapOfArea part(request.map, request.aoi, folder);
  for (const std::string& warning : part.warnings()) callbacks.warning(warning);
  WebMapRequest of_part = request;
  of_part.aoi.clear();
  of_part.map = part.path();
  if (of_part.dem.empty()) of_part.dem = dem_of_map(request.map);
  return make_web_map(of_part, callbacks);
}

}  // namespace

WebMapResult make_web_map(const WebMapRequest& request, const Callbacks& callbacks) {
  if (!request.aoi.empty()) return make_web_map_of_area(request, callbacks);
  check_request(request);
  const auto library =
      request.assets.empty() ? std::map<std::string, std::string>() : read_library(request.assets);
  const geodb::MapStore map = geodb::MapStore::open(request.map);
  const Crs& crs = map.crs();
  const auto extent = exporters::map_extent(request.map);
  const WebPlane plane = exporters::web_plane(crs, extent);
  const WebProjection projection(crs, plane);
  const auto all = exporters::read_web_landmarks(map, projection, request.types, request.min_confidence);
  if (all.landmarks.empty())
    throw Error(ErrorCode::input,
                all.outside > 0 ? "all landmarks lie beyond the edges of web maps"
                                : "the map has no landmarks to show",
                request.map, "check the map with: waymark query " + request.map);
  if (all.outside > 0)
    callbacks.warning(fmt::format("{} landmarks lie beyond {:.2f} degrees of latitude and are not on the map",
                                  all.outside, exporters::kMaxWebLatitude));

  exporters::WebStyle style{
      .title = request.title.empty() ? exporters::title_of(map.path().stem().string()) : request.title,
      .crs = crs,
      .plane = plane,
      .bounds = exporters::bounds_of(all.landmarks),
      .version = WAYMARK_VERSION};
  const double world_width = projection.world_width((style.bounds.north + style.bounds.south) / 2);
  WebMapResult result{.landmarks = static_cast<std::int64_t>(all.landmarks.size()), .outside = all.outside};
  result.max_zoom =
      request.max_zoom >= 0 ? request.max_zoom : exporters::top_zoom(all.landmarks, world_width);
  const auto relief = read_terrain(request, map, extent ? (extent->min_x + extent->max_x) / 2 : 0);
  std::optional<exporters::TerrainTiles> terrain;
  if (relief) {
    terrain.emplace(crs, plane, *relief);
    style.terrain_outline = terrain->outline();
    style.terrain_lowest = lowest_of(*relief);
    style.terrain_caption =
        fmt::format("Terrain, {:.3g} m per pixel", std::min(relief->cell_x, relief->cell_y));
    style.tint = exporters::hypsometric_tint(*relief, crs.body());
  }

  const exporters::WebShapes shapes = exporters::read_web_shapes(request.map, projection);
  style.shapes = shapes.layers;
  result.shapes = static_cast<std::int64_t>(shapes.shapes.size());
  if (shapes.outside > 0)
    callbacks.warning(fmt::format(
        "{} stands and crowns lie beyond the edges of web maps and are not on the map", shapes.outside));

  const fs::path output = request.output;
  std::error_code failed;
  fs::create_directories(output, failed);
  if (failed) fail_output(output, failed.message());
  AtomicFileSet files(output, output);
  TileMaker make{tbb::task_arena(request.threads > 0 ? request.threads : tbb::task_arena::automatic),
                 callbacks};
  PmtilesFile landmarks(files.path() / exporters::kLandmarkTiles, output / exporters::kLandmarkTiles);
  result.landmark_tiles = write_landmarks(make, landmarks, all, style, result.max_zoom);
  if (relief) {
    PmtilesFile tiles(files.path() / exporters::kTerrainTiles, output / exporters::kTerrainTiles);
    result.terrain_tiles = write_terrain(make, tiles, *terrain, crs, plane);
  }
  if (!shapes.shapes.empty()) {
    PmtilesFile tiles(files.path() / exporters::kShapeTiles, output / exporters::kShapeTiles);
    result.shape_tiles =
        write_shapes(make, tiles, shapes, style.title, exporters::top_zoom(shapes, world_width));
  }
  write_texts(files.path(), exporters::web_page_files(style.title), output);
  write_texts(files.path(), {{"style.json", exporters::web_style(all, style)}}, output);
  if (!library.empty()) {
    fs::create_directory(files.path() / "lib");
    write_texts(files.path() / "lib", library, output / "lib");
  }
  files.commit();
  if (!relief) fs::remove(output / exporters::kTerrainTiles);  // of an older map
  if (shapes.shapes.empty()) fs::remove(output / exporters::kShapeTiles);

  callbacks.summary(fmt::format("{}: {} landmarks in {} tiles to zoom {}, {}\n", output.string(),
                                result.landmarks, result.landmark_tiles, result.max_zoom,
                                size_text(output / exporters::kLandmarkTiles)));
  for (const exporters::WebShapeLayer& layer : shapes.layers)
    callbacks.summary(fmt::format("{} areas of layer {}\n", layer.count, layer.name));
  if (relief)
    callbacks.summary(fmt::format("{}, {} tiles, {}\n", style.terrain_caption, result.terrain_tiles,
                                  size_text(output / exporters::kTerrainTiles)));
  result.has_library = fs::exists(output / "lib");
  if (!result.has_library)
    callbacks.summary(
        fmt::format("Fetch the map library once: (cd {} && sh fetch-maplibre lib)\n", output.string()));
  return result;
}

}  // namespace waymark::workflows

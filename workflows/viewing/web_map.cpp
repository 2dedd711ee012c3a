// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/web_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "core/text_file.hpp"
#include "exporters/records/map_extent.hpp"
#include "exporters/report/map_drawing.hpp"
#include "exporters/web/terrain_tiles.hpp"
#include "exporters/web/thinning.hpp"
#include "exporters/web/web_page.hpp"
#include "exporters/web/web_style.hpp"
#include "geodb/map_store.hpp"
#include "pipeline/engine/sha256.hpp"
#include "workflows/query/map_of_area.hpp"
#include "workflows/viewing/write_web_tiles.hpp"

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

exporters::WebLandmarks read_landmarks(const WebMapRequest& request, const geodb::MapStore& map,
                                       const WebProjection& projection, const Callbacks& callbacks) {
  auto all = exporters::read_web_landmarks(map, projection, request.types, request.min_confidence);
  if (all.landmarks.empty())
    throw Error(ErrorCode::input,
                all.outside > 0 ? "all landmarks lie beyond the edges of web maps"
                                : "the map has no landmarks to show",
                request.map, "check the map with: waymark query " + request.map);
  if (all.outside > 0)
    callbacks.warning(fmt::format("{} landmarks lie beyond {:.2f} degrees of latitude and are not on the map",
                                  all.outside, exporters::kMaxWebLatitude));
  return all;
}

void summarize(const fs::path& output, const WebMapResult& result, const exporters::WebShapes& shapes,
               const std::string& terrain, const Callbacks& callbacks) {
  callbacks.summary(fmt::format("{}: {} landmarks in {} tiles to zoom {}, {}\n", output.string(),
                                result.landmarks, result.landmark_tiles, result.max_zoom,
                                size_text(output / exporters::kLandmarkTiles)));
  for (const exporters::WebShapeLayer& layer : shapes.layers)
    callbacks.summary(fmt::format("{} areas of layer {}\n", layer.count, layer.name));
  if (result.terrain_tiles > 0)
    callbacks.summary(fmt::format("{}, {} tiles, {}\n", terrain, result.terrain_tiles,
                                  size_text(output / exporters::kTerrainTiles)));
  if (!result.has_library)
    callbacks.summary(
        fmt::format("Fetch the map library once: (cd {} && sh fetch-maplibre lib)\n", output.string()));
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
  const auto all = read_landmarks(request, map, projection, callbacks);

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
  const TileWriting writing{request.threads, callbacks};
  PmtilesFile landmarks(files.path() / exporters::kLandmarkTiles, output / exporters::kLandmarkTiles);
  result.landmark_tiles = write_landmark_tiles(writing, landmarks, all, style, result.max_zoom);
  if (relief) {
    PmtilesFile tiles(files.path() / exporters::kTerrainTiles, output / exporters::kTerrainTiles);
    result.terrain_tiles = write_terrain_tiles(writing, tiles, *terrain, crs, plane);
  }
  if (!shapes.shapes.empty()) {
    PmtilesFile tiles(files.path() / exporters::kShapeTiles, output / exporters::kShapeTiles);
    result.shape_tiles =
        write_shape_tiles(writing, tiles, shapes, style.title, exporters::top_zoom(shapes, world_width));
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

  result.has_library = fs::exists(output / "lib");
  summarize(output, result, shapes, style.terrain_caption, callbacks);
  return result;
}

}  // namespace waymark::workflows

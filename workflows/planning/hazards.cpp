// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/hazards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "core/rotate_axes.hpp"
#include "exporters/raster/cog_stream.hpp"
#include "exporters/raster/occupancy_map.hpp"
#include "exporters/report/counting_area.hpp"
#include "geo/axes_rotation.hpp"
#include "geo/local_frame.hpp"
#include "geo/metric_crs.hpp"
#include "geodb/map_store.hpp"
#include "importers/rasters/dem.hpp"
#include "workflows/planning/hazard_extras.hpp"
#include "workflows/planning/raster_style.hpp"
#include "workflows/planning/raster_tiles.hpp"
#include "workflows/provenance.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

constexpr const char* kClassNames[] = {"safe", "uncertain", "hazard", "unknown"};

bool has_map_suffix(const std::string& input) {
  return fs::path(input).extension() == ".gpkg";
}

std::shared_ptr<const importers::ImportedDem> open_dem(const HazardMapRequest& request,
                                                       const geodb::MapStore* map) {
  std::vector<std::string> files = map ? request.dem : std::vector{request.input};
  if (map && files.empty()) {
    if (!map->has_dem_coverage())
      throw Error(ErrorCode::input, "the map has no heights", request.input,
                  "pass the elevation model with --dem, or make the map with `waymark run --with-dem`");
    files = {"GPKG:" + request.input + ":dem"};
  }
  const auto dem =
      importers::import_dem({.files = files,
                             .nodata = NodataPolicy::unknown,
                             .crs = map && map->crs().kind() == CrsKind::local ? "local" : request.crs,
                             .area = request.aoi,
                             .inspect = map == nullptr || !request.dem.empty()});
  const GridGeometry& grid = dem->geometry();
  if (grid.where.crs.kind() == CrsKind::geographic)
    throw Error(
        ErrorCode::input, "the DEM is in degrees: a vehicle needs metres", files.front(),
        fmt::format("project it: gdalwarp -t_srs {} {} metres.tif", fitting_metric_crs(grid), files.front()));
  return dem;
}

/// Landmarks in the axes of the DEM.
struct SiteObjects {
  Eigen::AlignedBox2d box = {};  ///< of all landmarks
  std::vector<planning::HazardObject> objects;
  std::vector<double> rock_diameters;  ///< of shadow casters, weighted by nothing: confidence of at least 0.5
};

SiteObjects read_objects(const geodb::MapStore& map, const Crs& dem, const planning::Vehicle& vehicle) {
  std::optional<CrsTransform> transform;
  if (!map.crs().same_as(dem)) transform.emplace(map.crs(), dem);
  const double metres = dem.metres_per_unit();
  SiteObjects site;
  for (const LandmarkType& type : map.types())
    map.visit(type.name, [&](Landmark&& landmark) {
      if (transform) {
        const Eigen::Vector3d own = landmark.position.xyz;
        rotate_axes(landmark, type.features,
                    [&] { return axes_rotation(*transform, map.crs(), dem, own.x(), own.y()); });
        const auto at = (*transform)(own.x(), own.y());
        if (!std::isfinite(at.x)) return;
        landmark.position.xyz.x() = at.x, landmark.position.xyz.y() = at.y;
      }
      site.box.extend(landmark.position.xyz.head<2>().eval());
      planning::HazardObject object = planning::hazard_object(landmark, type, vehicle);
      if (type.evidence == EvidenceModel::shadow_caster && landmark.confidence >= 0.5 && object.radius > 0)
        site.rock_diameters.push_back(2 * object.radius);
      if (!(object.probability > 1e-4)) return;
      object.radius /= metres, object.radius_sd /= metres, object.covariance /= metres * metres;
      site.objects.push_back(object);
    });
  return site;
}

/// Throws Error{input} if the boxes of the map's landmarks and of the DEM do not meet.
void check_on_dem(const SiteObjects& site, const GridGeometry& grid, const HazardMapRequest& request,
                  const std::vector<std::string>& files) {
  Eigen::AlignedBox2d dem(Eigen::Vector2d(grid.where.x(0), grid.where.y(0)));
  const double right = static_cast<double>(grid.columns - 1), bottom = static_cast<double>(grid.rows - 1);
  dem.extend(Eigen::Vector2d(grid.where.x(right), grid.where.y(bottom)));
  if (site.box.isEmpty() || dem.intersects(site.box)) return;
  const auto extent = [](const Eigen::AlignedBox2d& box) {
    return fmt::format("x {:.10g} to {:.10g}, y {:.10g} to {:.10g}", box.min().x(), box.max().x(),
                       box.min().y(), box.max().y());
  };
  throw Error(ErrorCode::input, "no landmark of the map lies on the DEM", files.empty() ? "" : files.front(),
              fmt::format("it covers {}, the landmarks {} in {}: {}", extent(dem), extent(site.box),
                          grid.where.crs.id(), request.input));
}

planning::UndetectedRocks undetected_rocks(const HazardMapRequest& request, const SiteObjects& site,
                                           const geodb::MapStore* map, const planning::Vehicle& vehicle,
                                           const Crs& dem, double cell, const Callbacks& callbacks) {
  planning::UndetectedRocks rocks{.min_height = vehicle.obstacle_height()};
  const double complete = completeness_diameter(site.rock_diameters);
  rocks.detected_diameter = request.detection_limit > 0 ? request.detection_limit
                            : std::isfinite(complete)   ? complete
                                                        : 4 * cell;
  std::optional<exporters::CountingArea> area;
  if (map) area = exporters::counting_area(*map);
  if (request.rock_cover >= 0) {
    rocks.known = true;
    rocks.cover.k = request.rock_cover;
  } else if (std::isfinite(complete) && area) {
    const auto count =
        std::ranges::count_if(site.rock_diameters, [&](double d) { return d >= rocks.detected_diameter; });
    rocks.known = true;
    rocks.cover = fit_rock_cover(count, rocks.detected_diameter, area->square_metres);
  } else {
    callbacks.warning(
        fmt::format("undetected rocks are not counted: {}; --rock-cover K gives the fraction of the terrain "
                    "that rocks cover",
                    map ? fmt::format("the map has {} rocks, 20 and the area of its images are needed",
                                      site.rock_diameters.size())
                        : "a DEM shows none smaller than some cells"));
  }
  if (area && map->crs().same_as(dem))
    for (const exporters::CountingArea::Ring& ring : area->rings) rocks.surveyed.push_back(ring.corners);
  return rocks;
}

/// Sets cells outside the area of interest to unknown.
void close_outside(Grid<float>& classes, const Window& window, const importers::ImportedDem& dem) {
  const Georeference& where = dem.geometry().where;
  for (std::int64_t r = 0; r < window.rows; ++r)
    for (std::int64_t c = 0; c < window.columns; ++c)
      if (!dem.in_area(where.x(static_cast<double>(window.column + c)),
                       where.y(static_cast<double>(window.row + r))))
        classes(c, r) = static_cast<float>(planning::HazardClass::unknown);
}

/// Warns of a CRS that stretches lengths at the middle of a grid, such as Web Mercator: slopes are wrong by
/// it.
void warn_of_stretch(const GridGeometry& grid, const std::string& file, const Callbacks& callbacks) {
  constexpr double kStep = 100, kMaxStretch = 0.02;  // m; a UTM zone has 0.001
  const Crs& crs = grid.where.crs;
  if (crs.kind() != CrsKind::projected) return;
  const double x = grid.where.x(static_cast<double>(grid.columns) / 2),
               y = grid.where.y(static_cast<double>(grid.rows) / 2), step = kStep / crs.metres_per_unit();
  const LocalFrame frame(crs, {{x, y, 0}});
  const auto stretch = [&](double dx, double dy) {
    return kStep / frame.map_frame_from_crs({{x + dx, y + dy, 0}}).xyz.head<2>().norm();
  };
  const double along_x = stretch(step, 0), along_y = stretch(0, step);
  if (!(std::max(std::abs(along_x - 1), std::abs(along_y - 1)) > kMaxStretch)) return;
  GridGeometry degrees;
  degrees.columns = degrees.rows = 1;
  const auto middle = CrsTransform(crs, geographic_crs(crs))(x, y);
  degrees.where = {geographic_crs(crs), middle.x, middle.y, 1, -1};
  callbacks.warning(fmt::format(
      "{} stretches lengths here, by {:.3g} along x and {:.3g} along y: slopes and sizes are wrong by that; "
      "project it: gdalwarp -t_srs {} {}",
      crs.id(), along_x, along_y, fitting_metric_crs(degrees), file));
}

std::string hazard_style() {
  return raster_style({.band = static_cast<int>(planning::HazardBand::probability) + 1,
                       .colours = {{0, "#1a9641", "0"},
                                   {0.05, "#a6d96a", "0.05"},
                                   {0.2, "#ffffbf", "0.2"},
                                   {0.5, "#fdae61", "0.5"},
                                   {1, "#d7191c", "1"}}});
}

void check(const HazardMapRequest& request) {
  const auto refuse = [](std::string problem, std::string hint) {
    throw Error(ErrorCode::usage, std::move(problem), "", std::move(hint));
  };
  if (fs::path(request.output).extension() != ".tif")
    refuse(fmt::format("the hazard map '{}' does not end in .tif", request.output), "it is a GeoTIFF");
  if (!request.polygons.empty() && !has_map_suffix(request.polygons))
    refuse(fmt::format("the polygons '{}' do not end in .gpkg", request.polygons), "they are a GeoPackage");
  if (!request.nav2.empty() && fs::path(request.nav2).extension() != ".yaml")
    refuse(fmt::format("the map of Nav2 '{}' does not end in .yaml", request.nav2), "");
  for (const std::string& output : {request.output, request.polygons, request.nav2}) {
    keep_inputs(output, {request.input, request.aoi, request.vehicle});
    keep_inputs(output, request.dem);
  }
  if (!(0 < request.min_uncertain && request.min_uncertain <= request.min_hazard && request.min_hazard <= 1))
    refuse(fmt::format("--uncertain {:g} and --hazard {:g} are no increasing probabilities",
                       request.min_uncertain, request.min_hazard),
           "0 < uncertain <= hazard <= 1");
  for (const auto& [name, value] :
       {std::pair("--height-sd", request.height_sd), {"--detection-limit", request.detection_limit}})
    if (!std::isnan(value)) check_number(name, value, "m", {.help = "", .min = 0, .max = 1e4});
  check_number("--height-correlation", request.height_correlation, "m", {.help = "", .min = 0, .max = 1e6});
  if (request.rock_cover < 0 || request.rock_cover > 1)
    refuse(fmt::format("--rock-cover {:g} is no fraction of the terrain", request.rock_cover),
           "0.01 is smooth, 0.07 typical of landing sites, 0.3 very rocky");
  check_number("--tile-cells", static_cast<double>(request.tile_cells), "",
               {.help = "", .min = 16, .max = 8192});
}

std::map<std::string, std::string> metadata(const HazardMapRequest& request,
                                            const planning::HazardRequest& hazard,
                                            const HazardMapResult& result) {
  const planning::UndetectedRocks& rocks = hazard.undetected;
  return {{"WAYMARK_VERSION", program_version()},
          {"VEHICLE", hazard.vehicle.name},
          {"BASE_RADIUS", fmt::format("{:g}", hazard.vehicle.base_radius())},
          {"HEIGHT_SD", fmt::format("{:g}", hazard.errors.sd)},
          {"HEIGHT_CORRELATION", fmt::format("{:g}", hazard.errors.correlation)},
          {"CLASSES", "0 safe, 1 uncertain, 2 hazard, 3 unknown"},
          {"CLASS_LIMITS", fmt::format("{:g} {:g}", request.min_uncertain, request.min_hazard)},
          {"LANDING_ELLIPSE", request.landing_ellipse},
          {"SUN", request.sun},
          {"ROCK_COVER", rocks.known ? fmt::format("{:.4g}", rocks.cover.k) : "unknown"},
          {"DETECTED_DIAMETER", fmt::format("{:.4g}", rocks.detected_diameter)},
          {"UNDETECTED_PER_METRE", fmt::format("{:.4g}", result.undetected_per_metre.value)}};
}

/// Writes the style, the polygons and the map of Nav2 beside the raster.
void write_companions(const HazardMapRequest& request, const Crs& crs) {
  write_file(fs::path(request.output).replace_extension(".qml"), hazard_style());
  const int bands = static_cast<int>(planning::kHazardBands);
  if (!request.polygons.empty())
    exporters::write_class_polygons(request.polygons, "hazard", request.output, bands, kClassNames, crs);
  if (!request.nav2.empty())
    exporters::write_occupancy_map(request.nav2, request.output, {.probability = bands - 1, .classes = bands},
                                   crs);
}

std::string summary_of(const HazardMapRequest& request, const GridGeometry& grid,
                       const planning::HazardRequest& hazard, const HazardMapResult& result) {
  const auto total = static_cast<double>(grid.cells());
  std::string text = fmt::format("{}: {} x {} cells for {}, {} objects\n", request.output, grid.columns,
                                 grid.rows, hazard.vehicle.name, result.objects);
  for (std::size_t i = 0; i < result.cells.size(); ++i)
    text += fmt::format("  {:<9} {:6.2f} %\n", kClassNames[i],
                        100 * static_cast<double>(result.cells[i]) / total);
  const planning::UndetectedRocks& rocks = hazard.undetected;
  if (rocks.known)
    text += fmt::format(
        "  rocks cover {:.3g} +- {:.2g} of the terrain; undetected hazardous rocks: {:.3g} +- {:.2g} per km "
        "driven\n",
        rocks.cover.k, rocks.cover.sd, 1000 * result.undetected_per_metre.value,
        1000 * result.undetected_per_metre.sd);
  return text;
}

}  // namespace

std::vector<std::string> hazard_class_names() {
  return {std::begin(kClassNames), std::end(kClassNames)};
}

HazardMapResult make_hazard_map(const HazardMapRequest& request, const Callbacks& callbacks) {
  check(request);
  const planning::Vehicle vehicle = planning::find_vehicle(request.vehicle);
  std::optional<geodb::MapStore> map;
  if (has_map_suffix(request.input))
    map.emplace(geodb::MapStore::open(request.input));
  else if (!request.dem.empty())
    throw Error(ErrorCode::usage, "--dem is the elevation model of a map, and the input is a DEM itself",
                request.input, "leave one out");
  const auto dem = open_dem(request, map ? &*map : nullptr);
  for (const std::string& warning : dem->warnings()) callbacks.warning(warning);
  const GridGeometry& grid = dem->geometry();
  const double metres = grid.where.crs.metres_per_unit(), cell = grid.where.dx * metres;

  warn_of_stretch(grid, request.input, callbacks);
  planning::HazardRequest hazard{
      .vehicle = vehicle,
      .errors = {std::isnan(request.height_sd) ? dem->height_sd() : request.height_sd,
                 request.height_correlation},
      .min_uncertain = request.min_uncertain,
      .min_hazard = request.min_hazard};
  if (!(hazard.errors.sd > 0))
    callbacks.warning(
        "the standard deviation of the heights is unknown, limits are sharp: --height-sd gives it");
  SiteObjects site;
  if (map) site = read_objects(*map, grid.where.crs, vehicle);
  check_on_dem(site, grid, request, dem->files());
  hazard.undetected =
      undetected_rocks(request, site, map ? &*map : nullptr, vehicle, grid.where.crs, cell, callbacks);
  HazardMapResult result{.objects = static_cast<std::int64_t>(site.objects.size()),
                         .undetected = hazard.undetected,
                         .undetected_per_metre = {}};
  const planning::Uncertain density = planning::undetected_density(hazard.undetected, true);
  result.undetected_per_metre = {density.value * vehicle.track_width(), density.sd * vehicle.track_width()};

  const planning::HazardMap hazards(*dem, hazard, std::move(site.objects));
  if (hazards.fitted_radius() > 1.5 * vehicle.base_radius())
    callbacks.warning(
        fmt::format("the cells of {:.3g} m are coarse for a base of {:.3g} m: relief is judged over {:.3g} m",
                    cell, 2 * vehicle.base_radius(), 2 * hazards.fitted_radius()));
  std::vector<exporters::CogStream::Band> bands;
  for (const auto& [name, unit] : planning::hazard_band_names()) bands.push_back({name, unit});
  const HazardExtras extras = parse_hazard_extras(request, grid);
  for (const auto& [name, unit] : extras.bands()) bands.push_back({name, unit});
  exporters::CogStream file(request.output, bands, grid);
  write_tiles(
      grid, {request.tile_cells, request.threads, "hazards"},
      [&](const Window& window, const auto&) {
        std::vector<Grid<float>> tile = compute_with_extras(hazards, *dem, window, extras);
        if (!request.aoi.empty()) close_outside(tile[planning::kHazardBands - 1], window, *dem);
        return tile;
      },
      [&](const std::vector<Grid<float>>& tile) {
        for (const float c : tile[planning::kHazardBands - 1].cells())
          ++result.cells.at(static_cast<std::size_t>(c));
      },
      file, callbacks);
  file.commit(metadata(request, hazard, result));
  write_companions(request, grid.where.crs);
  callbacks.summary(summary_of(request, grid, hazard, result));
  return result;
}

}  // namespace waymark::workflows

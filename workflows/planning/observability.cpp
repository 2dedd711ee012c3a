// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/observability.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "geo/point_at_height.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "planning/observability.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/planning/planning_sensor.hpp"
#include "workflows/planning/raster_style.hpp"
#include "workflows/planning/raster_tiles.hpp"
#include "workflows/provenance.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxRasterCells = 1e9;
constexpr double kDefaultCell = 2;     // m
constexpr double kDefaultCells = 1e6;  // a wider default cell makes no more

void check(const ObservabilityRequest& request) {
  const auto refuse = [](std::string problem, std::string hint) {
    throw Error(ErrorCode::usage, std::move(problem), "", std::move(hint));
  };
  if (fs::path(request.output).extension() != ".tif")
    refuse(fmt::format("the raster '{}' does not end in .tif", request.output), "it is a GeoTIFF");
  keep_inputs(request.output, {request.map, request.aoi, request.sensor});
  keep_inputs(request.output, request.dem);
  if (!std::isnan(request.cell))
    check_number("--cell", request.cell, "m", {.help = "", .min = 0.1, .max = 1000});
  if (!(request.drive > 0 && request.drive <= 1e5))
    refuse(fmt::format("--drive {:g} is outside (0, 100000] m", request.drive), "");
  check_number("--sensor-height", request.sensor_height, "m", {.help = "", .min = 0, .max = 1000});
  check_number("--tile-cells", static_cast<double>(request.tile_cells), "",
               {.help = "", .min = 16, .max = 8192});
}

/// Returns a cell of 1, 2 or 5 times a power of ten with which the area has about a million cells at most.
double default_cell(double square_metres) {
  double cell = kDefaultCell;
  for (int i = 0; square_metres > kDefaultCells * cell * cell; ++i)
    cell *= i % 3 == 0 ? 2.5 : 2;  // 5, 10, 20
  return cell;
}

/// Cells of the map's CRS about all landmarks and the range around them, or those of the area's box, aligned
/// to multiples of a cell.
GridGeometry grid_of(const RobotMap& map, const localization::LandmarkGrid& landmarks, double range,
                     const std::optional<importers::Area>& area, ObservabilityRequest& request) {
  const double metres = map.crs().metres_per_unit();
  Eigen::AlignedBox2d box;
  for (const localization::MapLandmark& landmark : landmarks.landmarks())
    box.extend(map.frame.crs_from_map_frame({{landmark.at.x(), landmark.at.y(), 0}}).xyz.head<2>().eval());
  box.min().array() -= range / metres, box.max().array() += range / metres;
  if (area) box = box.intersection(area->box());
  if (box.isEmpty())
    throw Error(ErrorCode::input, "no landmark can be seen from the area of interest", request.aoi,
                "draw it nearer to the landmarks of the map");
  if (std::isnan(request.cell)) request.cell = default_cell(box.volume() * metres * metres);
  const double cell = request.cell / metres;
  const double west = std::floor(box.min().x() / cell), east = std::ceil(box.max().x() / cell),
               south = std::floor(box.min().y() / cell), north = std::ceil(box.max().y() / cell);
  const double columns = east - west, rows = north - south;
  if (columns * rows > kMaxRasterCells)
    throw Error(ErrorCode::usage,
                fmt::format("--cell {:g} makes {:.0f} million cells of {:.1f} x {:.1f} km", request.cell,
                            columns * rows / 1e6, columns * request.cell / 1e3, rows * request.cell / 1e3),
                "",
                fmt::format("pass a cell of {:.2g} m or more",
                            request.cell * std::sqrt(columns * rows / kMaxRasterCells)));
  GridGeometry grid;
  grid.columns = static_cast<std::int64_t>(columns), grid.rows = static_cast<std::int64_t>(rows);
  grid.where = {map.crs(), (west + 0.5) * cell, (north - 0.5) * cell, cell, -cell};
  return grid;
}

/// Returns the box of the cells and of the landmarks in the map frame.
Eigen::AlignedBox2d sight_area(const GridGeometry& grid, const RobotMap& map,
                               const localization::LandmarkGrid& landmarks) {
  Eigen::AlignedBox2d box = landmarks.bounds();
  const double right = static_cast<double>(grid.columns - 1), bottom = static_cast<double>(grid.rows - 1);
  for (const auto& [c, r] :
       {std::pair(0.0, 0.0), std::pair(right, 0.0), std::pair(0.0, bottom), std::pair(right, bottom)})
    box.extend(plan_position(map.frame, grid.where.x(c), grid.where.y(r)));
  return box;
}

std::vector<Grid<float>> compute_tile(const Window& window, const GridGeometry& grid, const RobotMap& map,
                                      const planning::ObservabilityField& field,
                                      const std::optional<importers::Area>& area,
                                      const std::function<void(double)>& done) {
  constexpr std::size_t bands = std::size(planning::kObservabilityBands);
  std::vector<Grid<float>> out(
      bands, Grid<float>(window.columns, window.rows, std::numeric_limits<float>::quiet_NaN()));
  for (std::int64_t r = 0; r < window.rows; ++r) {
    done(static_cast<double>(r) / static_cast<double>(window.rows));
    for (std::int64_t c = 0; c < window.columns; ++c) {
      const double x = grid.where.x(static_cast<double>(window.column + c)),
                   y = grid.where.y(static_cast<double>(window.row + r));
      if (area && !area->contains(x, y)) continue;
      const Eigen::Vector2d at = plan_position(map.frame, x, y);
      const auto values = observability_bands(field.at(at.x(), at.y()));
      for (std::size_t b = 0; b < bands; ++b) out[b](c, r) = static_cast<float>(values[b]);
    }
  }
  return out;
}

/// Counts of standard deviations by classes of 5 %, for a median without the values.
class SdCounts {
 public:
  void add(const std::vector<Grid<float>>& tile) {
    const auto sd = tile[0].cells(), landmarks = tile[2].cells();
    for (std::size_t i = 0; i < sd.size(); ++i) {
      if (std::isnan(sd[i])) continue;  // outside the area of interest
      ++cells_;
      if (!(landmarks[i] > 0)) continue;
      ++seen_;
      ++count_[static_cast<int>(std::lround(std::log(std::max(1e-6F, sd[i])) / kStep))];
    }
  }
  double seen() const { return cells_ ? static_cast<double>(seen_) / static_cast<double>(cells_) : 0; }
  double median() const {
    std::int64_t below = 0;
    for (const auto& [at, n] : count_)
      if (2 * (below += n) >= seen_) return std::exp(at * kStep);
    return 0;
  }

 private:
  static constexpr double kStep = 0.05;
  std::map<int, std::int64_t> count_;
  std::int64_t cells_ = 0, seen_ = 0;
};

}  // namespace

ObservabilityResult make_observability(const ObservabilityRequest& given, const Callbacks& callbacks) {
  ObservabilityRequest request = given;
  check(request);
  const std::shared_ptr<const SensorProfile> sensor = find_sensor(request.sensor, request.map);
  planning::ObservabilityRules rules;
  rules.sensing.coverage = planning_coverage(*sensor, request.sensor, request.range, request.view);
  rules.drive = request.drive;
  const OpenedMap opened = open_robot_map(request.map, sensor.get());
  const RobotMap& map = opened.map;
  if (map.crs().kind() == CrsKind::geographic)
    throw Error(ErrorCode::input, "the map is in degrees: cells need metres", request.map,
                "export it into a projected CRS, e.g. its UTM zone");
  const localization::LandmarkGrid landmarks(all_landmarks(map, sensor.get()));
  std::optional<importers::Area> area;
  if (!request.aoi.empty()) area = importers::read_area_of_interest(request.aoi, map.crs());
  const GridGeometry grid = grid_of(map, landmarks, rules.sensing.coverage.range, area, request);
  rules.sensing.visible = planning_line_of_sight(map, request.dem, {.sensor_height = request.sensor_height},
                                                 sight_area(grid, map, landmarks), callbacks);
  const bool hides = static_cast<bool>(rules.sensing.visible);
  std::vector<exporters::CogStream::Band> bands;
  for (const auto& [name, unit] : planning::kObservabilityBands)
    bands.push_back({std::string(name), std::string(unit)});
  exporters::CogStream file(request.output, bands, grid);
  const planning::ObservabilityField field(landmarks, rules);
  SdCounts counts;
  write_tiles(
      grid, {request.tile_cells, request.threads, "observability"},
      [&](const Window& window, const std::function<void(double)>& done) {
        return compute_tile(window, grid, map, field, area, done);
      },
      [&](const std::vector<Grid<float>>& tile) { counts.add(tile); }, file, callbacks);
  file.commit({{"WAYMARK_VERSION", program_version()},
               {"SENSOR", sensor->name},
               {"RANGE", fmt::format("{:g}", rules.sensing.coverage.range)},
               {"VIEW", fmt::format("{:g}", rules.sensing.coverage.view)},
               {"DRIVE", fmt::format("{:g}", request.drive)},
               {"TERRAIN_HIDES", hides ? "yes" : "no"}});
  write_file(fs::path(request.output).replace_extension(".qml"),
             raster_style({.band = 1,
                           .colours = {{0, "#1a9641", "0"},
                                       {0.1, "#a6d96a", "0.1 m"},
                                       {0.3, "#ffffbf", "0.3 m"},
                                       {1, "#fdae61", "1 m"},
                                       {3, "#d7191c", "3 m and more"}}}));
  const ObservabilityResult result{grid.columns, grid.rows, request.cell, counts.seen(), counts.median()};
  callbacks.summary(fmt::format(
      "{}: {} x {} cells of {:g} m for {}\n  {:.1f} % with a landmark in sight; there the sd of the position "
      "is {:.2g} m in the median after {:g} m{}\n",
      request.output, grid.columns, grid.rows, request.cell, sensor->name, 100 * result.seen,
      result.median_sd, request.drive, hides ? "" : "\n  terrain hides no landmark: --dem gives it"));
  return result;
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/units.hpp"
#include "geo/axes_rotation.hpp"
#include "geo/point_at_height.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "workflows/parse_number.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kMaxCells = 4'000'000;
constexpr double kMaxExtent = 50e3;  // m from the origin of the map frame, which is a plane

[[noreturn]] void fail_waypoint(const Waypoint& point, const HazardClasses* hazards,
                                const std::string& file) {
  const auto kind = hazards ? hazards->at(point.at.x(), point.at.y()) : planning::HazardClass::safe;
  const char* problem = kind == planning::HazardClass::unknown
                            ? "is on unknown terrain or outside the hazard map"
                        : kind == planning::HazardClass::hazard ? "is in a hazard"
                        : hazards ? "is beside a hazard or the border of the area, within a cell of the route"
                                  : "is beside the border of the area, within a cell of the route";
  throw Error(
      ErrorCode::input, fmt::format("{} {}", point.text, problem), file,
      hazards ? "move it, make --cell finer, or pass --hazards none" : "move it, or make --cell finer");
}

}  // namespace

Waypoint parse_waypoint(const std::string& name, const std::string& text, const RobotMap& map) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    numbers.push_back(parse_number(name, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3)
    throw Error(ErrorCode::usage, fmt::format("{} {} is no position", name, text), "",
                "X,Y or X,Y,YAW in degrees");
  if (numbers.size() == 3 && name != "--from")
    throw Error(ErrorCode::usage, fmt::format("{} {} has three numbers: only --from has a yaw", name, text),
                "", "X,Y in the map's CRS");
  Waypoint point;
  point.at = plan_position(map.frame, numbers[0], numbers[1]);
  if (!(point.at.norm() < kMaxExtent))
    throw Error(
        ErrorCode::input,
        fmt::format("{} {} is {:.0f} km from the middle of the map", name, text, point.at.norm() / 1000),
        map.store->path().string(),
        fmt::format("positions are x,y in {}, at most {:.0f} km away", map.crs().id(), kMaxExtent / 1000));
  if (numbers.size() == 3) point.yaw = numbers[2] * kRadiansPerDegree - grid_rotation(map.frame, point.at);
  point.text = fmt::format("{} {}", name, text);
  return point;
}

HazardClasses::HazardClasses(const std::string& file, const RobotMap& map) : frame_(map.frame) {
  // Classes are small whole numbers, which the importer of heights reads as they are.
  const importers::DemImport classes{.files = {file},
                                     .nodata = NodataPolicy::unknown,
                                     .crs = map.crs().kind() == CrsKind::local ? "local" : "",
                                     .band = static_cast<int>(planning::kHazardBands),
                                     .inspect = false};
  if (importers::band_count(file) < classes.band)
    throw Error(ErrorCode::input, "this is no hazard map: it has no classes", file,
                "`waymark hazards` makes one");
  raster_ = importers::import_dem(classes);
  const GridGeometry& grid = raster_->geometry();
  if (!grid.where.crs.same_as(map.crs())) transform_.emplace(map.crs(), grid.where.crs);
  classes_ = raster_->read({0, 0, grid.columns, grid.rows});
}

double HazardClasses::cell() const {
  return raster_->geometry().where.dx * raster_->geometry().where.crs.metres_per_unit();
}

planning::HazardClass HazardClasses::at(double x, double y) const {
  const auto crs = frame_.crs_from_map_frame({{x, y, 0}}).xyz;
  CrsTransform::XY there{crs.x(), crs.y()};
  if (transform_) there = (*transform_)(there.x, there.y);
  const Georeference& where = raster_->geometry().where;
  const double c = std::round(where.column(there.x)), r = std::round(where.row(there.y));
  if (!(c >= 0 && r >= 0 && c < double(classes_.columns()) && r < double(classes_.rows())))
    return planning::HazardClass::unknown;
  const double value = classes_(static_cast<std::int64_t>(c), static_cast<std::int64_t>(r));
  return value >= 0 && value <= 3 ? static_cast<planning::HazardClass>(static_cast<int>(value))
                                  : planning::HazardClass::unknown;
}

planning::RouteCells cells_for(const std::vector<Waypoint>& points, double cell, double range) {
  Eigen::AlignedBox2d box;
  for (const Waypoint& point : points) box.extend(point.at);
  const double margin = std::max(range, box.diagonal().norm() / 2);
  planning::RouteCells cells{.cell = cell};
  cells.x0 = std::floor((box.min().x() - margin) / cell) * cell;
  cells.y0 = std::floor((box.min().y() - margin) / cell) * cell;
  cells.columns = static_cast<std::int64_t>(std::ceil((box.max().x() + margin - cells.x0) / cell)) + 1;
  cells.rows = static_cast<std::int64_t>(std::ceil((box.max().y() + margin - cells.y0) / cell)) + 1;
  if (cells.count() > kMaxCells)
    throw Error(
        ErrorCode::usage,
        fmt::format("the route needs {} x {} cells of {:g} m, more than {}", cells.columns, cells.rows, cell,
                    kMaxCells),
        "", fmt::format("--cell {:.2g}", 1.05 * cell * std::sqrt(double(cells.count()) / double(kMaxCells))));
  return cells;
}

std::vector<char> passable_cells(const planning::RouteCells& cells, const HazardClasses* hazards) {
  std::vector<char> passable(static_cast<std::size_t>(cells.count()), 1);
  if (!hazards) return passable;
  const int samples = std::max(1, static_cast<int>(std::ceil(cells.cell / hazards->cell())));
  for (std::int64_t i = 0; i < cells.count(); ++i)
    for (int k = 0; k < samples * samples && passable[static_cast<std::size_t>(i)]; ++k) {
      const double u = (k % samples + 0.5) / samples - 0.5, v = (k / samples + 0.5) / samples - 0.5;
      if (hazards->at(cells.x(i) + u * cells.cell, cells.y(i) + v * cells.cell) >=
          planning::HazardClass::hazard)
        passable[static_cast<std::size_t>(i)] = 0;
    }
  return passable;
}

void close_outside(const std::string& aoi, const RobotMap& map, const std::vector<Waypoint>& points,
                   const planning::RouteCells& cells, std::vector<char>& passable) {
  const importers::Area area = importers::read_area_of_interest(aoi, map.crs());
  const auto is_inside = [&](double x, double y) {
    const auto at = map.frame.crs_from_map_frame({{x, y, 0}}).xyz;
    return area.contains(at.x(), at.y());
  };
  for (const Waypoint& point : points)
    if (!is_inside(point.at.x(), point.at.y()))
      throw Error(ErrorCode::input, point.text + " is outside the area of interest", aoi,
                  "move it, or make the area larger");
  for (std::int64_t i = 0; i < cells.count(); ++i) {
    char& open = passable[static_cast<std::size_t>(i)];
    if (open && !is_inside(cells.x(i), cells.y(i))) open = 0;
  }
}

void check_known(const std::vector<Waypoint>& points, const HazardClasses* hazards, const std::string& file) {
  for (const Waypoint& point : points)
    if (hazards && hazards->at(point.at.x(), point.at.y()) == planning::HazardClass::unknown)
      fail_waypoint(point, hazards, file);
}

std::int64_t cell_of(const Waypoint& point, const planning::RouteCells& cells,
                     const std::vector<char>& passable, const HazardClasses* hazards,
                     const std::string& file) {
  const std::int64_t cell = cells.index(point.at.x(), point.at.y());
  if (cell >= 0 && passable[static_cast<std::size_t>(cell)]) return cell;
  fail_waypoint(point, hazards, file);
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "geo/dem_source.hpp"
#include "geo/local_frame.hpp"
#include "importers/rasters/dem.hpp"
#include "planning/hazard_map.hpp"
#include "planning/information_field.hpp"
#include "workflows/localization/robot_map.hpp"
namespace waymark::workflows {

/// A position that the route passes.
struct Waypoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< in the map frame, metres
  std::optional<double> yaw = {};                ///< radians from east towards north
  std::string text = {};                         ///< of messages: option and value
};

/// Returns the waypoint of `X,Y` or `X,Y,YAW` (degrees) in the map's CRS. Throws Error{usage} for other text,
/// Error{input} for positions over 50 km from the origin of the map frame.
Waypoint parse_waypoint(const std::string& name, const std::string& text, const RobotMap& map);

/// Classes of a hazard map at positions of the map frame.
class HazardClasses {
 public:
  /// Reads the whole band. Throws Error{input} if the file is no hazard map.
  HazardClasses(const std::string& file, const RobotMap& map);

  /// Returns the cell size in metres.
  double cell() const;
  /// Returns the class at x, y of the map frame; `unknown` outside the raster.
  planning::HazardClass at(double x, double y) const;

 private:
  LocalFrame frame_;
  std::shared_ptr<const importers::ImportedDem> raster_;
  std::optional<CrsTransform> transform_;
  HeightWindow classes_;
};

/// Throws Error{input} if a waypoint is on unknown terrain or outside the hazard map `file`; nothing is
/// checked without one.
void check_known(const std::vector<Waypoint>& points, const HazardClasses* hazards, const std::string& file);

/// Returns the cells of a search, with room for detours of half the distance, at least `range` metres, on all
/// sides. Throws Error{usage} for over 4 million cells.
planning::RouteCells cells_for(const std::vector<Waypoint>& points, double cell, double range);

/// Returns 1 for each cell in which no cell of the hazard map is a hazard or unknown; all 1 without a map.
std::vector<char> passable_cells(const planning::RouteCells& cells, const HazardClasses* hazards);

/// Sets to 0 each cell whose centre lies outside the polygons of the file `aoi`. Throws Error{input} if a
/// waypoint does, or the file has no polygon.
void close_outside(const std::string& aoi, const RobotMap& map, const std::vector<Waypoint>& points,
                   const planning::RouteCells& cells, std::vector<char>& passable);

/// Returns the cell of a waypoint. Throws Error{input} if it is not passable; `file` is the hazard map,
/// or the area without one.
std::int64_t cell_of(const Waypoint& point, const planning::RouteCells& cells,
                     const std::vector<char>& passable, const HazardClasses* hazards,
                     const std::string& file);

}  // namespace waymark::workflows

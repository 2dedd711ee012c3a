// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "testbed/town/town_model.hpp"
namespace waymark::testbed {

/// Wall, side of a car or leaf of a door at the height of the laser.
struct TownWall {
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
};

/// Post, stem, pillar or person: a circle, which may walk to and fro between two points.
struct TownPost {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0.1;
  Eigen::Vector2d to = Eigen::Vector2d::Zero();  ///< of its walk
  double speed = 0;                              ///< m/s; 0: it stands

  Eigen::Vector2d at_time(double t) const;
};

/// True landmark. Angles are azimuths, rad clockwise from north; values that a type lacks are absent.
struct TownLandmark {
  std::string type, kind;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::optional<double> direction = {}, opening_angle = {}, side = {}, orientation = {}, facing = {};
  std::optional<double> diameter = {}, height = {}, width = {}, length = {};
};

/// A street or a floor on level ground, with its truth and the path of a drive through it. Metres, x east, y
/// north.
struct Town {
  std::vector<TownWall> walls;
  std::vector<TownPost> posts;
  std::vector<TownLandmark> landmarks;
  std::vector<Eigen::Vector2d> path;  ///< a point every half metre

  /// Returns the range of the first hit of a ray at a time; `std::nullopt` if there is none. O(walls).
  std::optional<double> cast(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t) const;
};

/// Makes a street or a floor. `seed`: what stands; `drive_seed`: parked cars, open doors, people.
/// Deterministic.
Town plan_street(const StreetModel& model, std::uint64_t seed, std::uint64_t drive_seed);
Town plan_hall(const HallModel& model, std::uint64_t seed, std::uint64_t drive_seed);

/// Adds the walls of an outline, which runs with its inside on the left, and its corners seen from outside
/// (or from inside); corners of less than 30 degrees are none.
void add_outline(Town& town, const std::vector<Eigen::Vector2d>& outline, bool from_inside);

/// Returns points every half metre along a line of waypoints.
std::vector<Eigen::Vector2d> dense_path(const std::vector<Eigen::Vector2d>& waypoints);

/// Returns the table of the true landmarks: type,uid,x,y,... (docs/reference/town_scenario.md).
std::string town_table(const Town& town);

}  // namespace waymark::testbed

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "testbed/town/town_model.hpp"
namespace waymark::testbed {

/// How strongly a surface reflects a laser.
struct TownSurface {
  double reflectivity = 0.3;  ///< of a perpendicular beam, 0 to 1
  double gloss = 0;           ///< added to it by a glossy surface that is seen head-on
  bool retro = false;         ///< reflects back to the scanner at any angle, as signs and tape do
};

/// Wall, side of a car, leaf of a door, kerb or plate of a sign: an upright rectangle.
struct TownWall {
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
  double bottom = 0, top = 3;  ///< m above the road
  TownSurface surface = {};
  bool has_windows = false;
};

/// Post, stem, pillar or person: a circle, which may walk to and fro between two points.
struct TownPost {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0.1;
  Eigen::Vector2d to = Eigen::Vector2d::Zero();  ///< of its walk
  double speed = 0;                              ///< m/s; 0: it stands
  double top = 2;                                ///< m above the road
  TownSurface surface = {};

  Eigen::Vector2d at_time(double t) const;
};

/// Crown of a tree, which a beam may pass: a ball.
struct TownCrown {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< z above the road
  double radius = 1.5;
};

/// Gabled roof with its ridge along x, eaves included. Only surveys from the air see it.
struct TownRoof {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), half = Eigen::Vector2d::Zero();  ///< half: of its sides
  double ridge = 10, slope = 0.6;  ///< m above the road; tangent
};

/// First surfaces along a ray in the plane, at any height.
struct TownHit {
  double range = 0, along_wall = 0;  ///< m; along_wall: from the first end of a wall
  double cosine = 1;                 ///< of the angle between ray and normal
  double bottom = 0, top = 0;        ///< m above the road
  const TownSurface* surface = nullptr;
  bool has_windows = false;
  bool is_front = true;  ///< of a wall: it runs from the left to the right of the ray
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
  std::vector<TownCrown> crowns;
  std::vector<TownRoof> roofs;
  /// Of a street along x: |y| of the kerbs, m, and the heights of the pavements in the south and the north.
  double kerb = 1e9, kerb_south = 0, kerb_north = 0;

  /// Returns the height of the ground, m above the road.
  double ground(const Eigen::Vector2d& at) const {
    return at.y() > kerb ? kerb_north : at.y() < -kerb ? kerb_south : 0;
  }
  /// Calls visit(hit) for each wall and post on a ray, in no order.
  template <class Visit>
  void visit_hits(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t,
                  const Visit& visit) const;
  /// Returns the first hit of a level ray of a line scanner at a time; `std::nullopt` if there is none.
  std::optional<TownHit> hit(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t) const;
  /// Returns the range of the first hit of a ray at a time; `std::nullopt` if there is none. O(walls).
  std::optional<double> cast(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t) const;
};

template <class Visit>
void Town::visit_hits(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t,
                      const Visit& visit) const {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  for (const TownWall& wall : walls) {
    const Eigen::Vector2d run = wall.to - wall.from, off = wall.from - from;
    const double area = cross(along, run);
    if (std::abs(area) < 1e-12) continue;
    const double range = cross(off, run) / area, part = cross(off, along) / area, length = run.norm();
    if (range > 0 && part >= 0 && part <= 1)
      visit(TownHit{range, part * length, std::abs(area) / length, wall.bottom, wall.top, &wall.surface,
                    wall.has_windows, area < 0});
  }
  for (const TownPost& post : posts) {
    const Eigen::Vector2d off = post.at_time(t) - from;
    const double middle = off.dot(along), aside = cross(along, off);
    if (std::abs(aside) >= post.radius) continue;
    const double depth = std::sqrt(post.radius * post.radius - aside * aside);
    if (middle > depth)
      visit(TownHit{middle - depth, 0, depth / post.radius, 0, post.top, &post.surface, false});
  }
}

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

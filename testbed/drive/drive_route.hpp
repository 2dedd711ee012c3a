// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/drive/laser_targets.hpp"
namespace waymark::testbed {

/// Circular obstacle.
struct Obstacle {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// Returns the rocks higher than `height` metres; stems are no obstacles for a harvester.
std::vector<Obstacle> obstacles_of(std::span<const RockSolid> rocks, double height);

/// Traversable terrain: squares far enough from obstacles and the edge of the terrain, and not too steep.
class TraversableMap {
 public:
  /// `clearance`: minimum distance to obstacles, metres; `margin`: to the edge; `max_slope`: maximum slope,
  /// metres per metre.
  TraversableMap(const Terrain& terrain, std::span<const Obstacle> obstacles, double clearance, double margin,
                 double max_slope);
  bool free(const Eigen::Vector2d& at) const;
  /// Returns the shortest path over free squares (A*, Hart et al. 1968, eight neighbours). Both ends are
  /// moved to the nearest free square. Empty if there is none.
  std::vector<Eigen::Vector2d> shortest_path(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  static constexpr double kSquare = 0.5;
  struct Cell {
    std::int64_t column, row;
  };
  Cell cell(const Eigen::Vector2d& at) const;
  Eigen::Vector2d middle(const Cell& cell) const;
  std::optional<Cell> nearest_free(const Cell& cell) const;

  double x0_, y0_;
  Grid<std::uint8_t> free_;
};

/// Smooths a polyline by corner cutting (Chaikin 1974) and resamples it every `spacing` metres.
std::vector<Eigen::Vector2d> smooth_path(std::vector<Eigen::Vector2d> corners, double spacing);

/// Returns the corners of an automatic route of at least `length` metres in a rectangle of half size
/// `half_size` about the middle. Kinds:
/// - `loop`: irregular ring,
/// - `lanes`: parallel lanes to and fro,
/// - `wander`: random positions one after another.
std::vector<Eigen::Vector2d> automatic_route(const std::string& kind, const Eigen::Vector2d& middle,
                                             const Eigen::Vector2d& half_size, double length,
                                             double lane_spacing, Random& random);

}  // namespace waymark::testbed

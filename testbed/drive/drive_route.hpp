// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/drive/laser_targets.hpp"
namespace waymark {

/// A round thing not to be driven into.
struct Obstacle {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// Rocks higher than `height` metres; stems are no obstacles for a machine that fells them.
std::vector<Obstacle> obstacles_of(std::span<const RockSolid> rocks, double height);

/// Where a vehicle may go: squares that are far enough from obstacles, from the edge of the ground and from
/// slopes that are too steep.
class FreeGround {
 public:
  /// `clearance`: metres kept from obstacles; `margin`: from the edge; `steepest`: metres per metre.
  FreeGround(const Terrain& terrain, std::span<const Obstacle> obstacles, double clearance, double margin,
             double steepest);
  bool free(const Eigen::Vector2d& at) const;
  /// The shortest way from one place to another over free squares (A*, Hart et al. 1968, eight neighbours).
  /// Both ends are moved to the nearest free square. Empty where there is none.
  std::vector<Eigen::Vector2d> way(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

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

/// Corners cut (Chaikin 1974) until it is smooth, then points every `spacing` metres.
std::vector<Eigen::Vector2d> smooth_way(std::vector<Eigen::Vector2d> corners, double spacing);

/// Corners of an automatic route within a rectangle of this half size about the middle: `loop`, a ring that
/// wavers; `lanes`, to and fro; `wander`, random places one after another. At least `length` metres long.
std::vector<Eigen::Vector2d> automatic_route(const std::string& kind, const Eigen::Vector2d& middle,
                                             const Eigen::Vector2d& half_size, double length,
                                             double lane_spacing, Random& random);

}  // namespace waymark

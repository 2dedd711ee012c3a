// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "geo/terrain.hpp"
#include "testbed/landing/rock_solid.hpp"
namespace waymark::testbed {

/// Terrain with its rocks, as wheels feel it. Immutable; terrain and rocks must outlive it.
class DrivingSurface {
 public:
  DrivingSurface(const Terrain& terrain, std::span<const RockSolid> rocks);

  struct Point {
    double height = 0;  ///< m
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    bool on_rock = false;
  };
  /// Returns the surface at a position; `std::nullopt` outside the terrain and on unknown cells. Cost: the
  /// rocks within some metres.
  std::optional<Point> at(const Eigen::Vector2d& position) const;

  /// Where a wheel touches.
  struct Touch {
    double height = 0;                                  ///< m, of the lowest point of the rim
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< from the point of contact to the centre
    bool on_rock = false;
  };
  /// Returns where an upright wheel touches when it is lowered onto the surface, with the axis across
  /// `heading` (a horizontal unit vector). A rock is touched by the rim, before the centre is above it.
  std::optional<Touch> lower_wheel(const Eigen::Vector2d& centre, const Eigen::Vector2d& heading,
                                   double radius, double width) const;

  const Terrain& terrain() const { return terrain_; }

 private:
  const std::vector<std::uint32_t>* rocks_near(const Eigen::Vector2d& position) const;

  const Terrain& terrain_;
  std::span<const RockSolid> rocks_;
  Grid<std::vector<std::uint32_t>> squares_;  // rocks that a wheel may touch whose centre is in the square
};

}  // namespace waymark::testbed

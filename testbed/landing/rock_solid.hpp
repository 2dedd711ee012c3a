// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>
#include "core/frames.hpp"
#include "core/random.hpp"
namespace waymark::testbed {

enum class RockShape : std::uint8_t { ellipsoid, irregular, cylinder };

/// Convex rock for ray casting. Bounded by planes (irregular), by an ellipsoid about `foot`, or by an
/// upright elliptic cylinder from below `foot` up to `top`.
struct RockSolid {
  RockShape shape = RockShape::ellipsoid;
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< centre of its outline on the ground, GridFrame
  double half_x = 1, half_y = 1;                   ///< metres, half axes of the outline
  double turn = 0;                                 ///< of the x half axis, radians from east towards north
  double top = 1;                                  ///< metres above foot
  double reach = 1.5;                              ///< radius of the bounding sphere about foot
  std::vector<Eigen::Vector4f> planes;  ///< irregular: n (unit, out, local axes in metres), n.p <= w
  double brightness = 1;                ///< albedo relative to the ground
};

struct SolidHit {
  double t = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Returns where the ray enters; `std::nullopt` if it misses or starts inside. `along` need not be a unit
/// vector.
std::optional<SolidHit> intersect(const RockSolid& rock, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& along);

/// Returns whether the ray, from its origin on, passes through the rock. Cheaper than intersect().
bool intersects(const RockSolid& rock, const Eigen::Vector3d& origin, const Eigen::Vector3d& along);

}  // namespace waymark::testbed

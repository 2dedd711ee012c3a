// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "core/random.hpp"
#include "geo/terrain.hpp"
#include "testbed/forest/forest.hpp"
#include "testbed/landing/rock_solid.hpp"
namespace waymark::testbed {

/// Tree stem for ray casting: a leaning cone that exists until it is felled.
struct StemSolid {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();              ///< GridFrame
  double dbh = 0.3, height = 20;                               ///< metres
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();              ///< metres sideways per metre up
  double felled_at = std::numeric_limits<double>::infinity();  ///< s: time of felling

  /// Returns the radius at a height above the foot: dbh / 2 at 1.3 m, tapering to zero at the top.
  double radius(double above) const;
};

/// Branches and undergrowth: a ball that transmits a beam with probability exp(-density x path length).
struct Thicket {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.5;
  double density = 0.5;  ///< per metre
  double felled_at = std::numeric_limits<double>::infinity();
  std::int64_t stem = -1;  ///< index of the stem that bears the branches; -1: a bush
};

enum class TargetKind : std::uint8_t { ground, rock, stem, thicket };

/// Objects that sensors of a rover can hit, sorted into squares. Immutable and safe for concurrent reads.
/// The rocks must outlive it.
class LaserTargets {
 public:
  LaserTargets(Terrain terrain, std::span<const RockSolid> rocks, std::vector<StemSolid> stems = {},
               std::vector<Thicket> thickets = {});

  struct Target {
    TargetKind kind;
    std::uint32_t index;
    float x, y, reach;  ///< bounding upright cylinder
  };
  const Terrain& terrain() const { return terrain_; }
  std::span<const RockSolid> rocks() const { return rocks_; }
  const std::vector<StemSolid>& stems() const { return stems_; }
  const std::vector<Thicket>& thickets() const { return thickets_; }
  /// Returns the targets that may lie partly within `reach` of a position, in a fixed order.
  std::vector<Target> near(const Eigen::Vector2d& at, double reach) const;

 private:
  static constexpr double kSquare = 8;  // metres
  Terrain terrain_;
  std::span<const RockSolid> rocks_;
  std::vector<StemSolid> stems_;
  std::vector<Thicket> thickets_;
  Grid<std::vector<Target>> squares_;  // by the centre of the target
  double widest_ = 0;                  // largest reach of a target
};

/// Undergrowth and dead branches of a forest. `undergrowth`: bushes per hectare; `branchy`: fraction of the
/// trees with dead branches at scanner height.
struct ForestClutter {
  double undergrowth = 60;
  double branchy = 0.25;
};
struct ForestSolids {
  std::vector<StemSolid> stems;  ///< stems[i] is trees[i]; trees below 1.3 m have diameter 0
  std::vector<Thicket> thickets;
};
ForestSolids forest_solids(std::span<const StandingTree> trees, const ForestClutter& clutter,
                           const Terrain& terrain, std::uint64_t seed);

}  // namespace waymark::testbed

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include "core/frames.hpp"
#include "core/grid.hpp"
namespace waymark {

/// How a ray ended.
enum class RayEnd {
  ground,       ///< met the terrain: the point is on it
  sky,          ///< left the terrain's extent, or rises for ever, without meeting it
  no_data,      ///< passed where heights are unknown at or above the ray's lowest possible ground
  underground,  ///< began below the terrain, or came in through the side of the extent below it
};

struct RayHit {
  RayEnd end = RayEnd::sky;
  Point<GridFrame> point;  ///< where it ended; of `sky` meaningless
  double range = 0;        ///< metres from the origin
};

/// Heights at the nodes of a regular metric grid, bilinear between them, in memory, ready for rays.
/// Column c, row r lies at (x0 + c step_x, y0 - r step_y). Immutable; copies share it; many threads may ask.
class Terrain {
 public:
  /// Heights in metres, NaN or kNoHeight where unknown. Steps > 0, metres.
  Terrain(Grid<float> heights, double x0, double y0, double step_x, double step_y, double height_sd = 0);

  const Grid<float>& heights() const;
  double x0() const;
  double y0() const;
  double step_x() const;
  double step_y() const;
  double height_sd() const;
  double lowest() const;  ///< metres; NaN where nothing is known
  double highest() const;

  /// Bilinear height; nothing outside the extent and where one of the four nodes is unknown.
  std::optional<double> height(double x, double y) const;
  /// Upward unit normal of the bilinear patch.
  std::optional<Eigen::Vector3d> normal(double x, double y) const;

  /// First meeting of the ray with the ground, exact on the bilinear patches (residual < 1e-5 m).
  /// Max-mipmap quadtree (Tevs et al. 2008), O(log n) for coherent rays. Nothing farther than `most_range`
  /// metres is looked at: such rays end in the sky.
  RayHit cast(const Ray<GridFrame>& ray, double most_range = std::numeric_limits<double>::infinity()) const;
  /// Whether something stands between the point and the sun (or any direction). Points are lifted by 1 mm.
  bool in_shadow(const Point<GridFrame>& point, const Direction<GridFrame>& towards_light) const;

 private:
  struct Pyramid;
  std::shared_ptr<const Pyramid> pyramid_;
};

}  // namespace waymark

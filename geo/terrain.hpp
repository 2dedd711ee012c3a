// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include "core/frames.hpp"
#include "core/grid.hpp"
namespace waymark::inline geo {

/// Outcome of ray casting.
enum class RayEnd {
  ground,       ///< intersection with the terrain
  sky,          ///< no intersection within the extent and the range
  no_data,      ///< passes unknown cells, whose terrain may reach the ray
  underground,  ///< starts below the terrain, or enters the extent below it
};

struct RayHit {
  RayEnd end = RayEnd::sky;
  Point<GridFrame> point;  ///< end of the ray; meaningless for `sky`
  double range = 0;        ///< metres from the origin
};

/// Terrain in memory for ray casting: heights at the nodes of a regular metric grid, bilinear between them.
/// Column c, row r lies at (x0 + c step_x, y0 - r step_y). Immutable and thread-safe; copies share the
/// heights.
class Terrain {
 public:
  /// Heights in metres, NaN or kNoHeight if unknown. Steps > 0, metres. Throws Error for fewer than 2 x 2
  /// heights and for invalid steps.
  Terrain(Grid<float> heights, double x0, double y0, double step_x, double step_y, double height_sd = 0);

  const Grid<float>& heights() const;
  double x0() const;
  double y0() const;
  double step_x() const;
  double step_y() const;
  double height_sd() const;
  double min_height() const;  ///< metres; NaN if all heights are unknown
  double max_height() const;

  /// Returns the bilinear height; `std::nullopt` outside the extent and if one of the four nodes is unknown.
  std::optional<double> height(double x, double y) const;
  /// Returns the upward unit normal of the bilinear patch; `std::nullopt` as for height().
  std::optional<Eigen::Vector3d> normal(double x, double y) const;

  /// Returns the first intersection of the ray with the terrain, exact on the bilinear patches (residual <
  /// 1e-5 m). Rays without intersection up to `max_range` metres end in the sky. Max-mipmap quadtree (Tevs
  /// et al. 2008), O(log n) for coherent rays.
  RayHit cast(const Ray<GridFrame>& ray, double max_range = std::numeric_limits<double>::infinity()) const;
  /// Returns whether the terrain occludes the light from a direction. Points are lifted by 1 mm; unknown
  /// cells cast no shadow.
  bool in_shadow(const Point<GridFrame>& point, const Direction<GridFrame>& towards_light) const;
  /// Returns whether the terrain reaches the segment between two points. Unknown cells and what lies outside
  /// the extent do not. Cost as of cast().
  bool reaches(const Point<GridFrame>& from, const Point<GridFrame>& to) const;

 private:
  struct Pyramid;
  std::shared_ptr<const Pyramid> pyramid_;
};

}  // namespace waymark::inline geo

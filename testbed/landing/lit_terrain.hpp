// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "geo/sun.hpp"
#include "testbed/noise.hpp"
#include "testbed/scene.hpp"
namespace waymark::testbed {

/// Surface properties at a point of the terrain that determine its brightness.
struct SurfaceShading {
  double slope_x = 0, slope_y = 0;  ///< metres per metre
  double albedo = 0;
  double lit = 1;  ///< visible fraction of the sun's disc
};

/// Terrain of a scene under one sun, prepared for rendering: slopes, albedo and cast shadows, each averaged
/// over 1, 2, 4, ... cells to avoid aliasing. About 80 bytes per node.
class LitTerrain {
 public:
  LitTerrain(const Scene& scene, const Sun& sun);

  /// Returns the surface at a point, averaged over about `size` metres. Relief finer than the cells is
  /// added.
  SurfaceShading shading(const Eigen::Vector3d& point, double size) const;
  /// Returns the height above which the sun is visible over the terrain; shadow edges are accurate to about
  /// a cell.
  double shadow_height(double x, double y) const;
  const Sun& sun() const { return sun_; }

 private:
  double lit_fraction(double x, double y, double z) const;

  NodeGrid nodes_;
  Sun sun_;
  Grid<float> shadow_;
  std::vector<Grid<Eigen::Vector4f>> shading_levels_;  ///< slope x, slope y, albedo, lit; per level
  Fractal fine_;                                       ///< relief below the cell
  double fine_fall_ = 0.5;                             ///< amplitude ratio of successive octaves
  Eigen::Vector2d middle_;
  double soft_ = 0.01;  ///< metres of height over which the edge of a shadow fades
};

}  // namespace waymark::testbed

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "geo/sun.hpp"
#include "testbed/noise.hpp"
#include "testbed/scene.hpp"
namespace waymark {

/// What the light does at a place of the ground.
struct GroundLook {
  double slope_x = 0, slope_y = 0;  ///< metres per metre
  double albedo = 0;
  double lit = 1;  ///< share of the sun's disc that the terrain leaves free
};

/// A scene's ground under one sun, prepared for pictures: smooth slopes, albedo and cast shadows, each
/// averaged over 1, 2, 4, ... cells so that distant ground does not flicker. About 80 bytes per node.
class LitGround {
 public:
  LitGround(const Scene& scene, const Sun& sun);

  /// The ground at a point on it, averaged over about `size` metres. Relief finer than the cells is added.
  GroundLook look(const Eigen::Vector3d& point, double size) const;
  /// Height above which the sun is seen over the terrain; shadow edges are good to about a cell.
  double shadow_height(double x, double y) const;
  const Sun& sun() const { return sun_; }

 private:
  double in_light(double x, double y, double z) const;

  NodeGrid nodes_;
  Sun sun_;
  Grid<float> shadow_;
  std::vector<Grid<Eigen::Vector4f>> looks_;  ///< slope x, slope y, albedo, lit; per level
  Fractal fine_;                              ///< relief below the cell
  double fine_fall_ = 0.5;                    ///< from one of its octaves to the next
  Eigen::Vector2d middle_;
  double soft_ = 0.01;  ///< metres of height over which a shadow's edge falls
};

}  // namespace waymark

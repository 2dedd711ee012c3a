// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include "pipeline/buildings/roof_cells.hpp"
namespace waymark::pipeline {

/// Plane z = at_z + slope_x (x - at.x) + slope_y (y - at.y); metres.
struct RoofPlane {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double at_z = 0, slope_x = 0, slope_y = 0;
  double rms = 0;  ///< of the returns' distances from the plane

  double z(double x, double y) const { return at_z + slope_x * (x - at.x()) + slope_y * (y - at.y()); }
  /// Returns the cosine of the slope.
  double cosine() const { return 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y); }
  /// Returns the signed distance of a point, positive above.
  double distance(double x, double y, double height) const { return (height - z(x, y)) * cosine(); }
};

/// Sums of returns about a common origin, in metres.
class PlaneSums {
 public:
  /// `at_z` should be near the returns' heights, for precision.
  PlaneSums(const Eigen::Vector2d& at, double at_z) : at_(at), z_(at_z) {}
  void add(const CellSums& sums, const Eigen::Vector2d& centre);
  double count() const { return n_; }
  /// Fits the plane of least vertical squares. `std::nullopt` for fewer than six returns, or returns near one
  /// line.
  std::optional<RoofPlane> fit() const;

 private:
  Eigen::Vector2d at_;
  double z_;
  double n_ = 0, sx_ = 0, sy_ = 0, sz_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xz_ = 0, yz_ = 0, zz_ = 0;
};

/// Returns the root mean square distance of a cell's returns from a plane. 0 for a cell without returns.
double rms_distance(const CellSums& sums, const Eigen::Vector2d& centre, const RoofPlane& plane);

}  // namespace waymark::pipeline

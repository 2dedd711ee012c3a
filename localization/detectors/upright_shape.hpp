// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// A point of an upright object, in the frame of the scanner, m.
struct RaisedPoint {
  Eigen::Vector2f at;
  float height;  ///< above the ground
};

/// Circle of an upright pole.
struct UprightShape {
  Eigen::Vector2d axis;
  Eigen::Matrix2d covariance;
  double diameter = 0, diameter_sd = 0;
};

/// Fits a circle to the points of a pole as the scanner sees it.
/// - The diameter follows from the angle that each layer of 0.25 m fills, not from the depth of the arc:
///   noise of the ranges is as large as that depth. Of the layers the narrow ones count: a sign on a post is
///   wider.
/// - The axis lies behind the points by the depth of the circle there.
/// - Narrow poles far away are one column wide: the diameter is then near that of usual poles, 0.2 m.
/// `step`: angle between columns, radians. `std::nullopt` if the points are no circle or it is wider than
/// `max_diameter`, m.
std::optional<UprightShape> fit_upright(std::span<const RaisedPoint> points, double step,
                                        double max_diameter);

}  // namespace waymark::localization

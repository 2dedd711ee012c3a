// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "core/detection.hpp"
namespace waymark {

/// Where the rim was seen along one azimuth. Radii of the circle it was sought about.
struct RimPoint {
  double azimuth = 0;  ///< radians, from x towards y
  double radius = 1;
  double weight = 1;
};

/// A rim as radius over azimuth: r0 + a cos + b sin + c cos 2 + d sin 2, to first order an ellipse off the
/// centre.
struct RimShape {
  Eigen::Matrix<double, 5, 1> terms = Eigen::Matrix<double, 5, 1>::Unit(0);  ///< in radii
  double centre_sd = 0, radius_sd = 0;                                       ///< in radii

  double radius(double azimuth) const;
  /// About a circle at (x, y) of a radius in pixels.
  PixelEllipse ellipse(double x, double y, double radius) const;
};

/// Least squares with Huber's weights and a soft pull to the circle itself (sd 0.15 radii in size and place,
/// 0.04 in ellipticity), so that azimuths without points cannot run away. Weights count up to `full_weight`.
RimShape fit_rim(const std::vector<RimPoint>& points, double full_weight);

}  // namespace waymark

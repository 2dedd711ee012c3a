// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
#include "core/detection.hpp"
namespace waymark::pipeline {

/// Rim position along one azimuth, in radii of the candidate circle.
struct RimPoint {
  double azimuth = 0;  ///< radians, from x towards y
  double radius = 1;
  double weight = 1;
};

/// Rim as radius over azimuth: r0 + a cos + b sin + c cos 2 + d sin 2; to first order an ellipse with an
/// offset centre.
struct RimShape {
  Eigen::Matrix<double, 5, 1> terms = Eigen::Matrix<double, 5, 1>::Unit(0);  ///< in radii
  double centre_sd = 0, radius_sd = 0;                                       ///< in radii

  double radius(double azimuth) const;
  /// Returns the ellipse for a circle at (x, y) with a radius in pixels.
  PixelEllipse ellipse(double x, double y, double radius) const;
};

/// Fits a rim by least squares with Huber weights and a Gaussian prior at the circle: sd 0.15 radii in size
/// and position, 0.04 in ellipticity. The prior keeps azimuths without points from diverging. Weights are
/// capped at `full_weight`.
RimShape fit_rim(const std::vector<RimPoint>& points, double full_weight);

}  // namespace waymark::pipeline

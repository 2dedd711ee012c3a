// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include "core/observation.hpp"
namespace waymark::inline core {

/// Ellipse in an image. (0, 0) is the centre of the first pixel, x to the right, y down.
struct PixelEllipse {
  double x = 0, y = 0;          ///< centre
  double major = 0, minor = 0;  ///< full lengths of the axes, pixels, major >= minor
  double angle = 0;             ///< of the major axis, radians from x towards y, (-pi/2, pi/2]

  double diameter() const { return std::sqrt(major * minor); }
  friend bool operator==(const PixelEllipse&, const PixelEllipse&) = default;
};

/// Value measured in an image, with its standard deviation.
struct MeasuredValue {
  double value = 0, sd = 0;
  friend bool operator==(const MeasuredValue&, const MeasuredValue&) = default;
};

/// Landmark detected in one image, in pixels, before projection to the terrain.
struct Detection {
  TypeId type = 0;
  PixelEllipse outline;  ///< of the object at ground level, without its shadow
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * 0.25;  ///< of the outline's centre, px^2
  double diameter_sd = 0.5;                                         ///< of outline.diameter(), px
  /// Length of the object's shadow on level ground, pixels: height = shadow_reach x GSD x tan(sun elevation).
  /// `std::nullopt` for craters.
  std::optional<MeasuredValue> shadow_reach;
  /// Fractions of the terrain slope's effect on the logarithm of the shadow length that enter shadow_reach
  /// and the outline's diameter. shadow_reach: 1 if measured, less if the detector's prior contributes.
  /// Diameter: above 0 if long shadows enlarge it.
  double reach_slope_response = 1, diameter_slope_response = 0;
  double confidence = 1;  ///< calibrated probability that the object exists, (0, 1]

  friend bool operator==(const Detection&, const Detection&) = default;
};

}  // namespace waymark::inline core

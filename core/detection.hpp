// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include "core/observation.hpp"
namespace waymark {

/// An ellipse in an image. (0, 0) is the centre of the first pixel, x to the right, y down.
struct PixelEllipse {
  double x = 0, y = 0;          ///< centre
  double major = 0, minor = 0;  ///< full lengths of the axes, pixels, major >= minor
  double angle = 0;             ///< of the major axis, radians from x towards y, (-pi/2, pi/2]

  double diameter() const { return std::sqrt(major * minor); }
  friend bool operator==(const PixelEllipse&, const PixelEllipse&) = default;
};

/// A value read off an image, with its standard deviation.
struct Measured {
  double value = 0, sd = 0;
  friend bool operator==(const Measured&, const Measured&) = default;
};

/// A landmark seen in one image, in pixels: what a detector finds, before anything is known of the ground.
struct Detection {
  TypeId type = 0;
  PixelEllipse outline;  ///< of the thing itself where it meets the ground, not of its shadow
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity() * 0.25;  ///< of the outline's centre, px^2
  double diameter_sd = 0.5;                                         ///< of outline.diameter(), px
  /// Length of flat ground, pixels, that a shadow of the thing's full height covers: height on level ground =
  /// shadow_reach x GSD x tan(sun elevation). Rocks have it, craters do not.
  std::optional<Measured> shadow_reach;
  /// What share of what sloping ground does to a shadow's length (of its logarithm) is in shadow_reach: 1
  /// where it is measured, less where the detector leans on what it expects of such things. And what share is
  /// in the outline's diameter: where a long shadow makes a thing be taken for a large one.
  double reach_follows = 1, diameter_follows = 0;
  double confidence = 1;  ///< calibrated probability that the thing is there, (0, 1]

  friend bool operator==(const Detection&, const Detection&) = default;
};

}  // namespace waymark

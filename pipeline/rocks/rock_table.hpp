// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark {

/// What a rock's shadow measures: natural logarithms of its area (px^2) and of its extents (standard
/// deviations, px, pixel and blur included), and the way from its centroid back to the rock's middle, px.
struct ShadowMeasure {
  double log_area = 0, log_across = 0, log_along = 0;
  double offset = 0;
};
ShadowMeasure measure_of(const ShadowShape& shape);

/// Rock from shadow.
struct RockSize {
  double radius = 0, radius_sd = 0;  ///< of the outline, px
  double reach = 0, reach_sd = 0;    ///< px, see Detection::shadow_reach
  double offset = 0;                 ///< from the shadow's centroid towards the sun to the rock's middle, px
  double misfit = 0;                 ///< how far the shadow is from any rock's, in standard deviations
};

/// Shadows of rocks of many sizes and heights, drawn and measured as those in an image are: what threshold,
/// blur and pixels do to a measurement happens to both alike. Half ellipsoids and cylinders enter by three to
/// one.
class RockTable {
 public:
  /// Sun elevation in (0, pi/2); `known` narrows what is expected of heights. Takes some 30 ms.
  RockTable(Radians elevation, bool known, double blur);

  /// The rock that explains a shadow best; `noise` and `texture` are standard deviations in alpha.
  RockSize explain(const ShadowShape& shape, double noise, double texture) const;

  /// log(reach / radius) of a rock of usual height / diameter.
  double usual_log_ratio() const { return ratio_mean_; }

  double log_tan_elevation() const { return std::log(tan_elevation_); }  ///< of the sun it was made for
  bool knows_elevation() const { return known_; }

 private:
  static constexpr int kRadii = 11, kHeights = 8;
  ShadowMeasure at(double log_radius, double log_ratio) const;

  double tan_elevation_ = 1;
  bool known_ = false;
  double ratio_mean_ = 0, ratio_sd_ = 0.5;  // prior of log(reach / radius)
  double first_ratio_ = 0, ratio_step_ = 0.3;
  std::array<std::array<ShadowMeasure, kHeights>, kRadii> nodes_{};
};

}  // namespace waymark

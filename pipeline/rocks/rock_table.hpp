// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>

#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark::pipeline {

/// Measurements of a rock shadow: natural logarithms of its area (px^2) and extents (standard deviations,
/// px, pixel and blur included), and the distance from its centroid back to the centre of the rock, px.
struct ShadowMeasure {
  double log_area = 0, log_across = 0, log_along = 0;
  double offset = 0;
};
ShadowMeasure shadow_measure(const ShadowShape& shape);

/// Size of a rock estimated from its shadow.
struct RockSize {
  double radius = 0, radius_sd = 0;  ///< of the outline, px
  double reach = 0, reach_sd = 0;    ///< px, see Detection::shadow_reach
  double offset = 0;                 ///< from the shadow's centroid towards the sun to the rock's centre, px
  double misfit = 0;                 ///< distance of the shadow from that of any rock, in standard deviations
};

/// Lookup table of shadows of rocks of many sizes and heights, rendered and measured like those in an
/// image: threshold, blur and pixels bias both alike. Half ellipsoids and cylinders are mixed three to one.
class RockTable {
 public:
  /// Builds the table for a sun elevation in (0, pi/2) in about 30 ms. `known`: use the narrow prior of
  /// rock heights.
  RockTable(Radians elevation, bool known, double blur);

  /// Returns the rock that fits a shadow best; `noise` and `texture` are standard deviations in alpha.
  RockSize estimate_size(const ShadowShape& shape, double noise, double texture) const;

  /// Returns the prior mean of log(reach / radius).
  double mean_log_ratio() const { return ratio_mean_; }

  double log_tan_elevation() const { return std::log(tan_elevation_); }  ///< of the sun of the table
  bool elevation_known() const { return known_; }

 private:
  static constexpr int kRadii = 11, kHeights = 8;
  ShadowMeasure at(double log_radius, double log_ratio) const;

  double tan_elevation_ = 1;
  bool known_ = false;
  double ratio_mean_ = 0, ratio_sd_ = 0.5;  // prior of log(reach / radius)
  double first_ratio_ = 0, ratio_step_ = 0.3;
  std::array<std::array<ShadowMeasure, kHeights>, kRadii> nodes_{};
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/detection.hpp"
#include "core/observation.hpp"
#include "geo/sun.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"
namespace waymark::pipeline {

/// Returns the height of an object from the length of its shadow on sloping ground:
///   H = L (tan e + f g)
/// L is the horizontal length of the shadow, e the sun's elevation, g the rise of the ground per metre away
/// from the sun. The reach is converted to metres along the shadow's direction on the ground, which corrects
/// oblique views.
/// - `slope_sd` is the standard deviation of g.
/// - `slope_response`, f, is the response of the detected reach to the slope: 1 if measured, less if the
///   detector relies on the expected shape of rocks.
/// `std::nullopt` if the sun is below the ground's own horizon (tan e + g <= 0.02) or the shadow's direction
/// is not visible.
std::optional<MeasuredValue> height_from_shadow(const MeasuredValue& reach_px, const ImageView& image,
                                                const GroundPlane& ground, const Sun& sun, double slope_sd,
                                                double slope_response = 1);

/// Returns the log of the factor by which the slope shortens shadows, ln((tan e + g) / tan e), clamped to
/// +-ln 2.
/// 0 for a sun in the zenith or not above the level horizon.
double log_shadow_shortening(const GroundPlane& ground, const Sun& sun);

/// Parameters that images and terrain do not provide.
struct ProjectionRules {
  double height_sd = 0;       ///< metres, of a terrain without its own
  bool heights_known = true;  ///< false: the terrain is an assumed plane, so positions have no height
  double slope_sd = 0.03;     ///< of the ground under a rock relative to the terrain, metres per metre
  /// Fraction of the way from the crest to the steepest change of brightness at which outlines of craters lie
  /// (crest_correction.hpp): 1 for edge detectors, 0 for detectors that report crests.
  /// The built-in detector starts at the edge and moves 0.35 of the way to its modelled crest
  /// (bowl_verification.cpp).
  double outline_edge_fraction = 0.65;
  /// Standard deviation of a centre due to shape, in diameters: along the sun for objects detected by their
  /// shadow, isotropic for rims.
  double shadow_shape = 0.1, rim_shape = 0.035;
};

/// Projects a detection onto the terrain.
/// - The line of sight of its centre is intersected with the terrain; its outline is projected onto the
///   tangent plane there, for bowls of at least four cells onto the plane through the rim.
/// - Features are measured in horizontal projection, metres: that of LandmarkType::body, major_axis,
///   minor_axis, orientation; height from the shadow; depth of bowls from the terrain. Unmeasurable features
///   are absent.
/// - Bowls get the width of their crests if the terrain shows their degradation.
/// - Covariance = image + pose + terrain height along the line of sight + shape; feature variances are those
///   of the measurement.
/// Observation::position is in the grid frame (metres). If no ground is visible, `rejected` gives the reason
/// and the position is NaN.
Observation project_detection(const Detection& detection, const ImageView& image, const Terrain& terrain,
                              const LandmarkType& type, const ProjectionRules& rules);

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::pipeline {

/// Error of a feature that all images of one sun share: shading, penumbra and blur bias them alike. Its
/// standard deviation is hypot(fraction x value, pixels x ground sample distance of the finest image).
struct CommonError {
  double fraction = 0, pixels = 0;
};

/// Returns the common error of a feature of rocks and craters; `std::nullopt` for features without a measured
/// one. Figures: docs/evaluation/2026-11-23-feature-deviations.md.
std::optional<CommonError> common_error(EvidenceModel evidence, std::string_view feature);

/// Returns the standard deviation of the orientation of a rim with these full axes that all images share,
/// radians: near that of an unknown direction, pi / sqrt(12), unless the axes differ by more than a tenth.
/// Figures: docs/evaluation/2026-11-25-orientations-of-craters.md.
double orientation_error(double major_axis, double minor_axis);

/// Turns the spread of each feature into the variance of its value: spread / observations + common variance.
/// Unknown values and variances stay unknown, and features without a common error stay as they are. The
/// orientation of a bowl gets orientation_error(). `finest_gsd` in metres; not finite: only the fraction
/// counts.
void add_common_errors(Landmark& landmark, const LandmarkType& type, double finest_gsd);

/// Adds what an unknown slope of the ground contributes to the variance of heights from shadows, which all
/// images of a sun share: 0.1 (m/m, standard deviation along the light) x 0.4 (response of heights to slopes,
/// docs/methods/rocks.md) / tan(elevation of the sun) of the height. For maps without a DEM.
void add_slope_error(Landmark& landmark, const LandmarkType& type, double tan_sun_elevation);

/// A feature's variance in a map: spread of the observations, and what all images of a sun have in common.
struct VarianceParts {
  double spread = 0, common = 0;
};

/// Splits the variance of a mapped feature. Eq. 6 gives the spread from q_f, `confidence`; a variance that is
/// the spread has no common part.
VarianceParts split_variance(const FeatureValue& mapped, const FeatureSpec& spec,
                             std::optional<double> confidence);

}  // namespace waymark::pipeline

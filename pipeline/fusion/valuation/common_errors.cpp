// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/common_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark::pipeline {
namespace {

struct FeatureError {
  EvidenceModel evidence;
  std::string_view feature;
  CommonError error;
};

// Fitted so that 90 % of true values lie within 1.645 deviations in each quarter of sizes in pixels.
constexpr std::array kFeatureErrors{
    FeatureError{EvidenceModel::shadow_caster, "radius", {.fraction = 0.09, .pixels = 0.28}},
    FeatureError{EvidenceModel::shadow_caster, "height", {.fraction = 0.14, .pixels = 0.15}},
    FeatureError{EvidenceModel::bowl, "radius", {.fraction = 0.08, .pixels = 0.90}},
    FeatureError{EvidenceModel::bowl, "major_axis", {.fraction = 0.08, .pixels = 1.80}},
    FeatureError{EvidenceModel::bowl, "minor_axis", {.fraction = 0.08, .pixels = 1.80}},
    FeatureError{EvidenceModel::bowl, "depth", {.fraction = 0.13, .pixels = 0.20}},
};

constexpr double kUnknownAxis =
    std::numbers::pi / 2 / std::numbers::sqrt3;  // of a direction without a sense, radians

// Standard deviation of the difference of a rim's axes over their mean. It contains that small differences
// are mostly errors: the axes of simulated craters differ by 3 %, and measured ones by 6 %.
constexpr double kAxesError = 0.2;

double feature_value(const Landmark& landmark, const LandmarkType& type, std::string_view name) {
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i)
    if (type.features[i].name == name) return landmark.features[i].value;
  return std::nan("");
}

void add_orientation_error(Landmark& landmark, const LandmarkType& type) {
  if (type.evidence != EvidenceModel::bowl) return;
  const double sd = orientation_error(feature_value(landmark, type, "major_axis"),
                                      feature_value(landmark, type, "minor_axis"));
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i) {
    FeatureValue& axis = landmark.features[i];
    if (type.features[i].name != "orientation" || !axis.known() || !std::isfinite(sd)) continue;
    if (axis.observations > 1 || axis.variance > 0)
      axis.variance = std::min(axis.variance / axis.observations + sd * sd, kUnknownAxis * kUnknownAxis);
  }
}

}  // namespace

double orientation_error(double major_axis, double minor_axis) {
  const double difference = 2 * (major_axis - minor_axis) / (major_axis + minor_axis);
  return 1 / std::hypot(2 * difference / kAxesError, 1 / kUnknownAxis);
}

std::optional<CommonError> common_error(EvidenceModel evidence, std::string_view feature) {
  const auto* const found = std::ranges::find_if(
      kFeatureErrors, [&](const FeatureError& e) { return e.evidence == evidence && e.feature == feature; });
  if (found == kFeatureErrors.end()) return std::nullopt;
  return found->error;
}

void add_common_errors(Landmark& landmark, const LandmarkType& type, double finest_gsd) {
  const double gsd = std::isfinite(finest_gsd) ? finest_gsd : 0;
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i) {
    FeatureValue& feature = landmark.features[i];
    const std::optional<CommonError> error = common_error(type.evidence, type.features[i].name);
    const bool has_variance = feature.observations > 1 || feature.variance > 0;
    if (!error || !feature.known() || !has_variance) continue;
    const double common = std::hypot(error->fraction * feature.value, error->pixels * gsd);
    feature.variance = feature.variance / feature.observations + common * common;
  }
  add_orientation_error(landmark, type);
}

void add_slope_error(Landmark& landmark, const LandmarkType& type, double tan_sun_elevation) {
  constexpr double kUnknownSlope = 0.1;  // tangent; RMS of the testbed's ground over 1 m is 0.09 to 0.12
  constexpr double kResponse = 0.4;
  if (type.evidence != EvidenceModel::shadow_caster || !(tan_sun_elevation > 0)) return;
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i) {
    FeatureValue& height = landmark.features[i];
    const bool has_variance = height.observations > 1 || height.variance > 0;
    if (type.features[i].name != "height" || !height.known() || !has_variance) continue;
    const double error = kResponse * kUnknownSlope / tan_sun_elevation * height.value;
    height.variance += error * error;
  }
}

VarianceParts split_variance(const FeatureValue& mapped, const FeatureSpec& spec,
                             std::optional<double> confidence) {
  const double unit = spec.scale == Scale::ratio ? std::abs(mapped.value) : spec.reference;
  if (!confidence || !(*confidence > 0) || !(unit > 0)) return {mapped.variance, 0};
  const double spread = (1 - *confidence) * unit * (1 - *confidence) * unit;
  if (std::abs(spread - mapped.variance) <= 1e-6 * spread) return {mapped.variance, 0};
  return {spread, std::max(0.0, mapped.variance - spread / mapped.observations)};
}

}  // namespace waymark::pipeline

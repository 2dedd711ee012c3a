// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/common_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

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

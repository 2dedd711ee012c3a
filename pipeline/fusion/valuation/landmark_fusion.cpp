// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/landmark_fusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/covariance.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/valuation/common_errors.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

namespace waymark::pipeline {
namespace {

bool has_covariance(const Landmark& landmark) {
  return is_covariance(Eigen::Matrix2d(landmark.covariance.topLeftCorner<2, 2>()));
}

void fuse_positions(const Landmark& a, const Landmark& b, const CommonEvidence& common,
                    const TypeRegistry& types, const Crs& crs, Landmark& into) {
  if (has_covariance(a) != has_covariance(b)) {
    const Landmark& known = has_covariance(a) ? a : b;
    into.position = known.position;
    into.covariance = known.covariance;
    return;
  }
  MergeRules rules;
  if (common.observations > 0) rules.common_fraction = 1;
  const std::array both{as_observation(a, "a"), as_observation(b, "b")};
  const Landmark merged = merge_as_one(both, types, crs, rules);
  into.position = merged.position;
  into.covariance = has_covariance(a) ? merged.covariance : a.covariance;
}

/// Returns the variance of n observations about their mean from two groups.
double pooled_spread(const FeatureValue& a, const FeatureValue& b, double mean, Scale scale) {
  const double n = a.observations, m = b.observations;
  const double from_a = difference(a.value, mean, scale), from_b = difference(b.value, mean, scale);
  return ((n - 1) * a.variance + (m - 1) * b.variance + n * from_a * from_a + m * from_b * from_b) /
         (n + m - 1);
}

/// Returns the variance of the mean of two values with stated variances; 0 if one is not known.
double surer(double a, double b) {
  return a > 0 && b > 0 ? a * b / (a + b) : 0;
}

void fuse_feature(const FeatureSpec& spec, FeatureValue& a, std::optional<double>& confidence, FeatureValue b,
                  std::optional<double> other_confidence, int common) {
  if (!b.known()) return;
  if (!a.known()) {
    a = b;
    confidence = other_confidence;
    return;
  }
  const VarianceParts of_a = split_variance(a, spec, confidence);
  const VarianceParts of_b = split_variance(b, spec, other_confidence);
  a.variance = of_a.spread;
  b.variance = of_b.spread;
  const WeightedValue values[] = {{a.value, double(a.observations)}, {b.value, double(b.observations)}};
  FeatureValue fused = merge(values, spec.scale);
  fused.variance = pooled_spread(a, b, fused.value, spec.scale);
  const double stated = a.observations == 1 && b.observations == 1 ? surer(a.variance, b.variance) : 0;
  fused.observations = std::max({a.observations, b.observations, a.observations + b.observations - common});
  a = fused;
  confidence = spread_confidence(fused, spec.scale, spec.reference);
  a.variance = std::max(a.variance, stated);
}

int missed_of(const Landmark& landmark, int found_by_other) {
  return std::max(0, landmark.quality.visible - landmark.quality.seen - found_by_other);
}

double fused_confidence(const Landmark& a, const Landmark& b, const CommonEvidence& common,
                        const LandmarkType& type) {
  const double best = std::max(a.confidence, b.confidence);
  if (common.observations > 0) return best;
  const std::array both{a.confidence, b.confidence};
  const double fused =
      existence_probability(both, 0, {.further_detection = type.existence.further_detection});
  return std::min(a.confidence, b.confidence) >= 0.5 ? std::max(fused, best) : fused;
}

}  // namespace

Observation as_observation(const Landmark& landmark, const std::string& source) {
  Observation seen;
  seen.type = landmark.type;
  seen.landmark_uid = landmark.uid;
  seen.source = source;
  seen.position = landmark.position;
  seen.covariance = landmark.covariance;
  seen.confidence = std::clamp(landmark.confidence, 1e-3, 1.0);
  seen.features = landmark.features;
  for (FeatureValue& feature : seen.features)
    if (feature.known()) feature.observations = 1;
  return seen;
}

Landmark fuse_landmarks(const Landmark& a, const Landmark& b, const CommonEvidence& common,
                        const TypeRegistry& types, const Crs& crs) {
  const LandmarkType& type = types[a.type];
  const bool first = a.observations >= b.observations;
  Landmark fused = first ? a : b;
  const Landmark& other = first ? b : a;
  fuse_positions(a, b, common, types, crs, fused);
  for (std::size_t f = 0; f < type.features.size(); ++f)
    fuse_feature(type.features[f], fused.features[f], fused.quality.feature_confidences[f], other.features[f],
                 other.quality.feature_confidences[f], common.observations);
  if (std::isfinite(common.finest_gsd)) add_common_errors(fused, type, common.finest_gsd);
  for (std::size_t i = 0; i < fused.attributes.size(); ++i)
    if (std::holds_alternative<std::monostate>(fused.attributes[i]))
      fused.attributes[i] = other.attributes[i];

  const int missed_a = missed_of(a, common.found_by_b), missed_b = missed_of(b, common.found_by_a);
  const int missed = missed_a + missed_b - std::min({missed_a, missed_b, common.missed});
  fused.quality.seen = a.quality.seen + b.quality.seen - common.sources;
  fused.quality.visible = fused.quality.seen + missed;
  fused.confidence = fused_confidence(a, b, common, type);
  fused.observations = a.observations + b.observations - common.observations;
  return fused;
}

}  // namespace waymark::pipeline

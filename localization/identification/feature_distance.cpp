// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/feature_distance.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "core/error.hpp"

namespace waymark::localization {

FeatureScales::FeatureScales(const TypeRegistry& types) {
  for (const LandmarkType& type : types) {
    auto& scales = scales_.emplace_back();
    auto& weights = weights_.emplace_back();
    scales.fill(Scale::ratio);
    for (std::size_t i = 0; i < std::min(type.features.size(), kMaxFeatures); ++i) {
      const FeatureSpec& f = type.features[i];
      scales[i] = f.scale;
      weights[i].reference = f.reference;
      if (f.scale == Scale::ratio && std::isfinite(f.max_value) && f.max_value > 0)
        weights[i].typical = std::sqrt(f.max_value * (f.min_value > 0 ? f.min_value : 1e-3 * f.max_value));
    }
    reaches_.push_back(type.identification_reach);
    lines_.push_back(line_features(type));
  }
}

double FeatureScales::difference(TypeId type, std::size_t feature, double a, double b) const {
  return type < scales_.size() ? waymark::difference(a, b, scales_[type][feature]) : a - b;
}

bool FeatureScales::has_angles(TypeId type) const {
  return type < scales_.size() && std::ranges::any_of(scales_[type], waymark::is_angle);
}

double FeatureScales::tolerance_sd(TypeId type, std::size_t feature, double value, double tolerance) const {
  return tolerance *
         (is_angle(type, feature) ? weights_[type][feature].reference : std::max(std::abs(value), 1e-3));
}

double FeatureScales::identification_reach(std::optional<TypeId> type) const {
  if (type && *type < reaches_.size()) return reaches_[*type];
  return reaches_.empty() ? LandmarkType{}.identification_reach : std::ranges::min(reaches_);
}

double FeatureScales::alpha(TypeId type, std::size_t feature, double tolerance) const {
  const Weight weight = type < weights_.size() ? weights_[type][feature] : Weight{};
  if (weight.alpha > 0) return weight.alpha;
  return 1 / (weight.reference > 0 ? weight.reference : std::max(tolerance, 1e-3) * weight.typical);
}

void FeatureScales::set_alpha(TypeId type, std::size_t feature, double alpha) {
  weights_.at(type).at(feature).alpha = alpha;
}

void set_alphas(FeatureScales& scales, const TypeRegistry& types, std::string_view list) {
  const auto refuse = [whole = std::string(list)](const std::string& what) {
    throw Error(ErrorCode::usage, what, "--set alpha=" + whole, "e.g. rock.radius=4,rock.height=2");
  };
  while (!list.empty()) {
    const std::string_view item = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), item.size() + 1));
    const std::size_t dot = item.find('.'), equals = item.find('=');
    if (dot == item.npos || equals == item.npos || equals < dot)
      refuse("a weight of eq. 11 is TYPE.FEATURE=VALUE, is '" + std::string(item) + "'");
    const LandmarkType* type = types.find(item.substr(0, dot));
    if (!type) refuse("the map has no type '" + std::string(item.substr(0, dot)) + "'");
    const std::string_view name = item.substr(dot + 1, equals - dot - 1);
    const auto feature = std::ranges::find(type->features, name, &FeatureSpec::name);
    const std::size_t index = static_cast<std::size_t>(feature - type->features.begin());
    if (feature == type->features.end() || index >= kMaxFeatures)
      refuse("type " + type->name + " has no feature '" + std::string(name) + "'");
    const std::string number(item.substr(equals + 1));
    char* end = nullptr;
    const double alpha = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !(alpha > 0 && std::isfinite(alpha)))
      refuse("the weight of " + type->name + "." + std::string(name) + " must be positive, is '" + number +
             "'");
    scales.set_alpha(types.id(type->name), index, alpha);
  }
}

KnownFeatures features_in_map(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                              double sensor_yaw, double yaw_variance) {
  KnownFeatures mapped = seen;
  if (!scales.has_angles(type)) return mapped;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i) || !scales.is_angle(type, i)) continue;
    mapped.value[i] = scales.difference(type, i, std::numbers::pi / 2 - sensor_yaw, seen.value[i]);
    mapped.variance[i] += yaw_variance;
  }
  return mapped;
}

KnownFeatures features_without_angles(const FeatureScales& scales, TypeId type, KnownFeatures seen) {
  if (!scales.has_angles(type)) return seen;
  for (std::size_t i = 0; i < kMaxFeatures; ++i)
    if (scales.is_angle(type, i)) seen.value[i] = std::numeric_limits<double>::quiet_NaN();
  return seen;
}

std::vector<AngleFix> yaws_from_angles(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                       const KnownFeatures& mapped, double sensor_yaw, double tolerance) {
  std::vector<AngleFix> fixes;
  if (!scales.has_angles(type)) return fixes;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i) || !mapped.known(i) || !scales.is_angle(type, i)) continue;
    const double off =
        scales.difference(type, i, std::numbers::pi / 2 - mapped.value[i] - seen.value[i], sensor_yaw);
    const double slack = scales.tolerance_sd(type, i, mapped.value[i], tolerance);
    const double variance = seen.variance[i] + mapped.variance[i] + slack * slack + 1e-12;
    fixes.push_back({{wrap_angle(sensor_yaw + off), std::sqrt(variance)}, scales.period(type, i)});
  }
  return fixes;
}

FeatureComparison compare_features(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                   const KnownFeatures& mapped, double tolerance) {
  FeatureComparison all;
  for (std::size_t i = 0; i < kMaxFeatures; ++i) {
    if (!seen.known(i)) continue;
    if (!mapped.known(i)) {
      ++all.missing;
      continue;
    }
    const double d = scales.difference(type, i, seen.value[i], mapped.value[i]);
    const double slack = scales.tolerance_sd(type, i, mapped.value[i], tolerance);
    const double square = d * d / (seen.variance[i] + mapped.variance[i] + slack * slack + 1e-12);
    all.squares += square;
    all.largest = std::max(all.largest, square);
    const double weighted = d * scales.alpha(type, i, tolerance);
    all.weighted_squares += weighted * weighted;
    all.largest_weighted = std::max(all.largest_weighted, weighted * weighted);
    ++all.used;
  }
  return all;
}

}  // namespace waymark::localization

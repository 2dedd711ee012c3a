// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/plausible_landmark.hpp"

#include <fmt/format.h>

#include "core/covariance.hpp"

namespace waymark::importers {

bool is_possible_covariance(const Eigen::Matrix3d& c) {
  if (c(0, 0) < 0 || c(1, 1) < 0 || c(2, 2) < 0) return false;
  const Eigen::Matrix2d plane = c.topLeftCorner<2, 2>();
  return !plane.allFinite() || is_covariance(plane);
}

std::string find_implausibility(const LandmarkType& type, const Landmark& landmark) {
  for (std::size_t i = 0; i < type.features.size(); ++i) {
    const FeatureSpec& feature = type.features[i];
    const FeatureValue& value = landmark.features[i];
    if (!value.known()) continue;
    const std::string unit = feature.unit.empty() ? "" : " " + feature.unit;
    if (value.value < feature.min_value)
      return fmt::format("{} {} below {:g}{}", type.name, feature.name, feature.min_value, unit);
    if (value.value > feature.max_value)
      return fmt::format("{} {} above {:g}{}", type.name, feature.name, feature.max_value, unit);
    if (value.variance < 0) return fmt::format("negative deviation of {}", feature.name);
  }
  if (!is_possible_covariance(landmark.covariance)) return "its position deviations are no covariance";
  if (!(landmark.confidence >= 0 && landmark.confidence <= 1)) return "confidence outside 0 to 1";
  return {};
}

}  // namespace waymark::importers

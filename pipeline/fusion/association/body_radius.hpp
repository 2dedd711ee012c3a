// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/feature.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::pipeline {

/// Feature that holds the horizontal size of a type: a size feature called "radius", or one whose name ends
/// in "diameter".
/// Types without one (mountain tops) are associated by position alone.
struct BodySize {
  std::size_t feature = 0;
  double radius_per_value = 1;  ///< 1 or 1/2
};
std::optional<BodySize> body_size(const LandmarkType& type);

/// Radius of the body in metres, > 0, and the variance of its logarithm.
struct BodyRadius {
  double metres = 0, log_variance = 0;
};
std::optional<BodyRadius> body_radius(const std::optional<BodySize>& size, const FeatureSet& features);

}  // namespace waymark::pipeline

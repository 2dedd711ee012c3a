// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/feature.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::pipeline {

/// Index of the feature of LandmarkType::body.
/// Types without a body are associated by position alone.
struct BodyIndex {
  std::size_t feature = 0;
  double radius_per_value = 1;
};
std::optional<BodyIndex> body_index(const LandmarkType& type);

/// Radius of the body in metres, > 0, and the variance of its logarithm.
struct BodyRadius {
  double metres = 0, log_variance = 0;
};
std::optional<BodyRadius> body_radius(const std::optional<BodyIndex>& size, const FeatureSet& features);

}  // namespace waymark::pipeline

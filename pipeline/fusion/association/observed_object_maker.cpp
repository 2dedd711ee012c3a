// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/observed_object_maker.hpp"

#include <algorithm>
#include <cmath>

#include "core/covariance.hpp"

namespace waymark::pipeline {
namespace {

// Returns an invertible covariance, limited to the smallest standard deviation of the rules; invalid input is
// replaced.
Eigen::Matrix2d usable_covariance(const Eigen::Matrix3d& covariance, double radius, const MergeRules& rules) {
  const double min_sd = std::max(rules.min_sd, rules.min_sd_per_radius * radius);
  Eigen::Matrix2d plane = covariance.topLeftCorner<2, 2>();
  plane = (plane + plane.transpose()).eval() / 2;
  if (!is_covariance(plane))
    plane = Eigen::Matrix2d::Identity() * std::max(radius, 1.0) * std::max(radius, 1.0);
  return plane + Eigen::Matrix2d::Identity() * min_sd * min_sd;
}

}  // namespace

ObservedObjectMaker::ObservedObjectMaker(const TypeRegistry& types, const MergeRules& rules)
    : types_(&types), rules_(&rules) {
  for (const LandmarkType& type : types) sizes_.push_back(body_index(type));
}

ObservedObject ObservedObjectMaker::operator()(const Observation& o) const {
  ObservedObject s;
  const auto body = body_radius(sizes_.at(o.type), o.features);
  s.at = o.position.xyz.head<2>();
  s.covariance = usable_covariance(o.covariance, body ? body->metres : 0, *rules_);
  if (body) s.log_size = std::log(body->metres), s.log_size_variance = body->log_variance;
  const auto& features = (*types_)[o.type].features;
  const auto direction = std::ranges::find(features, Scale::direction, &FeatureSpec::scale);
  const auto index = static_cast<std::size_t>(direction - features.begin());
  if (direction != features.end() && index < o.features.size() && o.features[index].known())
    s.direction = o.features[index].value, s.direction_variance = o.features[index].variance;
  s.type = o.type;
  return s;
}

}  // namespace waymark::pipeline

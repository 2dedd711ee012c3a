// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/observed_object.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace waymark::pipeline {
namespace {

double largest_eigenvalue(const Eigen::Matrix2d& m) {
  const double mean = (m(0, 0) + m(1, 1)) / 2, half = (m(0, 0) - m(1, 1)) / 2;
  return mean + std::hypot(half, m(0, 1));
}

// Returns whether sizes are similar and centres nearer than a fraction of the smaller radius.
bool inside(const ObservedObject& a, const ObservedObject& b, double distance, double fraction,
            const AssociationRules& rules) {
  if (!(std::abs(a.log_size - b.log_size) <= std::log(rules.max_size_ratio))) return false;
  return distance <= fraction * std::exp(std::min(a.log_size, b.log_size));
}

}  // namespace

bool are_duplicates(const ObservedObject& a, const ObservedObject& b, const MapPlane& plane,
                    const AssociationRules& rules) {
  return inside(a, b, plane.offset(a.at, b.at).norm(), rules.duplicate_overlap, rules);
}

double gate_radius(const ObservedObject& object, const AssociationRules& rules) {
  const double by_position = std::sqrt(rules.position_gate * (largest_eigenvalue(object.covariance) +
                                                              rules.position_floor * rules.position_floor));
  const double by_overlap = std::isnan(object.log_size) ? 0 : rules.overlap * std::exp(object.log_size);
  return std::min(std::max(by_position, by_overlap), rules.max_distance);
}

std::optional<double> association_cost(const ObservedObject& a, const ObservedObject& b,
                                       const MapPlane& plane, const AssociationRules& rules) {
  const Eigen::Vector2d apart = plane.offset(a.at, b.at);
  const double distance = apart.norm();
  if (!(distance <= rules.max_distance)) return std::nullopt;
  const Eigen::Matrix2d sum = a.covariance + b.covariance +
                              2 * rules.position_floor * rules.position_floor * Eigen::Matrix2d::Identity();
  const double determinant = sum(0, 0) * sum(1, 1) - sum(0, 1) * sum(1, 0);
  const double squared = (sum(1, 1) * apart.x() * apart.x() - 2 * sum(0, 1) * apart.x() * apart.y() +
                          sum(0, 0) * apart.y() * apart.y()) /
                         determinant;
  double cost = squared + std::log(determinant);
  const bool overlapping = inside(a, b, distance, rules.overlap, rules);
  if (!(squared <= rules.position_gate) && !overlapping) return std::nullopt;
  const double turn = difference(a.direction, b.direction, Scale::direction);
  if (!std::isnan(turn)) {
    const double variance =
        a.direction_variance + b.direction_variance + 2 * rules.direction_floor * rules.direction_floor;
    if (!(turn * turn <= rules.direction_gate * variance)) return std::nullopt;
    cost += turn * turn / variance + std::log(variance);
  }
  const double size_apart = a.log_size - b.log_size;
  if (std::isnan(size_apart)) return cost;
  const double variance = a.log_size_variance + b.log_size_variance + 2 * rules.size_floor * rules.size_floor;
  if (!(size_apart * size_apart <= rules.size_gate * variance) && !overlapping) return std::nullopt;
  return cost + size_apart * size_apart / variance + std::log(variance);
}

ObservedObject fuse(const ObservedObject& a, const ObservedObject& b, const MapPlane& plane) {
  ObservedObject both = a;
  const Eigen::Matrix2d sum = a.covariance + b.covariance;
  const Eigen::Matrix2d gain = a.covariance * sum.inverse();
  both.at = plane.translate(a.at, gain * plane.offset(a.at, b.at));
  const Eigen::Matrix2d left = a.covariance - gain * a.covariance;
  both.covariance = (left + left.transpose()) / 2;
  constexpr double kMin = 1e-6;  // variance of a value given without error
  const double turn = difference(b.direction, a.direction, Scale::direction);
  if (std::isnan(a.direction)) {
    both.direction = b.direction, both.direction_variance = b.direction_variance;
  } else if (!std::isnan(turn)) {
    const double va = a.direction_variance + kMin, vb = b.direction_variance + kMin;
    both.direction = a.direction + turn * va / (va + vb);
    both.direction_variance = va * vb / (va + vb);
  }
  if (std::isnan(a.log_size) || std::isnan(b.log_size)) {
    if (std::isnan(a.log_size)) both.log_size = b.log_size, both.log_size_variance = b.log_size_variance;
    return both;
  }
  const double va = a.log_size_variance + kMin, vb = b.log_size_variance + kMin;
  both.log_size = (a.log_size * vb + b.log_size * va) / (va + vb);
  both.log_size_variance = va * vb / (va + vb);
  return both;
}

}  // namespace waymark::pipeline

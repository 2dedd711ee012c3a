// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/sighting.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

double largest_eigenvalue(const Eigen::Matrix2d& m) {
  const double mean = (m(0, 0) + m(1, 1)) / 2, half = (m(0, 0) - m(1, 1)) / 2;
  return mean + std::hypot(half, m(0, 1));
}

// Bodies of like size, their centres nearer than a share of the smaller radius.
bool inside(const Sighting& a, const Sighting& b, double distance, double share, const IdentityRules& rules) {
  if (!(std::abs(a.log_size - b.log_size) <= std::log(rules.alike))) return false;
  return distance <= share * std::exp(std::min(a.log_size, b.log_size));
}

}  // namespace

bool stand_in_each_other(const Sighting& a, const Sighting& b, const MapPlane& plane,
                         const IdentityRules& rules) {
  return inside(a, b, plane.offset(a.at, b.at).norm(), rules.twin, rules);
}

double reach(const Sighting& sighting, const IdentityRules& rules) {
  const double by_position = std::sqrt(rules.position_gate * largest_eigenvalue(sighting.covariance));
  const double by_overlap = std::isnan(sighting.log_size) ? 0 : rules.overlap * std::exp(sighting.log_size);
  return std::min(std::max(by_position, by_overlap), rules.max_distance);
}

std::optional<double> same_thing_cost(const Sighting& a, const Sighting& b, const MapPlane& plane,
                                      const IdentityRules& rules) {
  const Eigen::Vector2d apart = plane.offset(a.at, b.at);
  const double distance = apart.norm();
  if (!(distance <= rules.max_distance)) return std::nullopt;
  const Eigen::Matrix2d sum = a.covariance + b.covariance;
  const double determinant = sum(0, 0) * sum(1, 1) - sum(0, 1) * sum(1, 0);
  const double squared = (sum(1, 1) * apart.x() * apart.x() - 2 * sum(0, 1) * apart.x() * apart.y() +
                          sum(0, 0) * apart.y() * apart.y()) /
                         determinant;
  double cost = squared + std::log(determinant);
  const bool stands_inside = inside(a, b, distance, rules.overlap, rules);
  if (!(squared <= rules.position_gate) && !stands_inside) return std::nullopt;
  const double size_apart = a.log_size - b.log_size;
  if (std::isnan(size_apart)) return cost;
  const double variance = a.log_size_variance + b.log_size_variance + 2 * rules.size_floor * rules.size_floor;
  if (!(size_apart * size_apart <= rules.size_gate * variance) && !stands_inside) return std::nullopt;
  return cost + size_apart * size_apart / variance + std::log(variance);
}

Sighting fused(const Sighting& a, const Sighting& b, const MapPlane& plane) {
  Sighting both = a;
  const Eigen::Matrix2d sum = a.covariance + b.covariance;
  const Eigen::Matrix2d gain = a.covariance * sum.inverse();
  both.at = plane.moved(a.at, gain * plane.offset(a.at, b.at));
  const Eigen::Matrix2d left = a.covariance - gain * a.covariance;
  both.covariance = (left + left.transpose()) / 2;
  if (std::isnan(a.log_size) || std::isnan(b.log_size)) {
    if (std::isnan(a.log_size)) both.log_size = b.log_size, both.log_size_variance = b.log_size_variance;
    return both;
  }
  constexpr double kLeast = 1e-6;  // of a size told without error
  const double va = a.log_size_variance + kLeast, vb = b.log_size_variance + kLeast;
  both.log_size = (a.log_size * vb + b.log_size * va) / (va + vb);
  both.log_size_variance = va * vb / (va + vb);
  return both;
}

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/focal_vote.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/solve.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kBound = 0.1;          // cost of a pair that contradicts
constexpr double kVoteContrast = 0.01;  // mean cost must rise by this much at 1.3 times the focal length

double cost_at(std::span<const FocalEvidence> evidence, double focal) {
  double sum = 0, weights = 0;
  const Eigen::Vector3d scale(focal, focal, 1);
  for (const FocalEvidence& one : evidence) {
    const Eigen::Matrix3d essential = scale.asDiagonal() * one.fundamental * scale.asDiagonal();
    const Eigen::Vector3d values = singular_values(essential).values;
    if (!(values[0] > 0)) continue;
    sum += one.weight * std::min(kBound, 1 - values[1] / values[0]);
    weights += one.weight;
  }
  return weights > 0 ? sum / weights : kBound;
}

}  // namespace

std::optional<double> vote_focal_length(std::span<const FocalEvidence> evidence, double low, double high) {
  if (evidence.empty() || !(low > 0) || !(high > low)) return std::nullopt;
  constexpr int kSteps = 400;
  const double step = std::pow(high / low, 1.0 / kSteps);
  double best = low, lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    const double focal = low * std::pow(step, i), cost = cost_at(evidence, focal);
    if (cost < lowest) {
      lowest = cost;
      best = focal;
    }
  }
  if (best <= low * step || best >= high / step) return std::nullopt;
  const double beside = std::min(cost_at(evidence, best * 1.3), cost_at(evidence, best / 1.3));
  return beside > lowest + kVoteContrast ? std::optional(best) : std::nullopt;
}

}  // namespace waymark::pipeline

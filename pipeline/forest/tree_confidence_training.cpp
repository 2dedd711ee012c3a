// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_confidence_training.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace waymark::pipeline {

TreetopTerms fit_tree_confidence(std::span<const TreetopExample> examples) {
  using Vector = Eigen::Matrix<double, 6, 1>;
  constexpr double kRidge = 0.01;
  Vector weights = Vector::Zero();
  for (int round = 0; round < 40; ++round) {
    Vector slope = -kRidge * weights;
    Eigen::Matrix<double, 6, 6> curvature = kRidge * Eigen::Matrix<double, 6, 6>::Identity();
    for (const TreetopExample& one : examples) {
      const TreetopTerms values = regression_terms(one.evidence);
      const Vector terms = Eigen::Map<const Vector>(values.data());
      const double p = 1 / (1 + std::exp(-weights.dot(terms)));
      slope += ((one.is_tree ? 1 : 0) - p) * terms;
      curvature += p * (1 - p) * terms * terms.transpose();
    }
    weights += curvature.ldlt().solve(slope);
  }
  TreetopTerms rounded{};
  for (std::size_t i = 0; i < rounded.size(); ++i)
    rounded[i] = std::round(1000 * weights[static_cast<Eigen::Index>(i)]) / 1000;
  return rounded;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "localization/slam/graph.hpp"
namespace waymark::localization {

/// Marginal covariances of the poses and landmarks of a graph.
struct GraphMarginals {
  std::vector<Eigen::Matrix3d> poses;
  std::vector<Eigen::Matrix2d> landmarks;
};

/// Returns the marginal covariance of each pose and landmark of a solved graph: the diagonal blocks of the
/// inverse information matrix. Throws Error{input} if the graph is not determined.
/// - Computes them from its sparse Cholesky factor by the recursion of Takahashi (1973; Kaess & Dellaert
///   2009), without the inverse.
/// - Errors are weighted by `kernel` and its width (graph_solver.hpp).
/// - A fixed pose, and the first one of an unanchored graph, has covariance 0.
GraphMarginals graph_marginals(const PoseGraph& graph, const std::string& kernel = "none",
                               double kernel_width = 2);

}  // namespace waymark::localization

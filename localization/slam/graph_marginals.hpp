// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "localization/slam/graph.hpp"
namespace waymark {

struct GraphMarginals {
  std::vector<Eigen::Matrix3d> poses;
  std::vector<Eigen::Matrix2d> landmarks;
};

/// Covariances of each pose and landmark of a solved graph, the others unknown as they are: the diagonal
/// blocks of the inverse information matrix, from its sparse Cholesky factor by the recursion of Takahashi
/// (1973; Kaess & Dellaert 2009), without the inverse. Errors count as `kernel` and its width weigh them
/// (graph_solver.hpp). A fixed pose, and the first one where nothing else holds the graph, has covariance 0.
/// Throws Error{input} where the graph is not determined.
GraphMarginals graph_marginals(const PoseGraph& graph, const std::string& kernel = "none",
                               double kernel_width = 2);

}  // namespace waymark

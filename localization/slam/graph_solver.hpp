// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/options.hpp"
#include "localization/slam/graph.hpp"
namespace waymark {

struct GraphOptions {
  std::int64_t block = 200;       ///< poses added between two optimisations; 0: all at once
  std::int64_t iterations = 100;  ///< at most, of the last optimisation
  std::string kernel =
      "auto";  ///< none, huber, cauchy: how sightings and loops that do not fit count; auto: none
  double kernel_width = 2;  ///< standard deviations from which the kernel counts an error less
  bool covariances = true;

  void describe(OptionVisitor& option);
};

struct GraphSolution {
  PoseGraph graph;        ///< with poses and landmarks where they belong
  double chi2 = 0;        ///< sum of squared whitened errors, without kernel
  double start_chi2 = 0;  ///< as the poses were before
  std::size_t residuals = 0, unknowns = 0;
  int iterations = 0, optimisations = 0;
  bool converged = false;
  std::vector<Eigen::Matrix3d> pose_covariances;  ///< x, y, yaw; empty if not asked for
  std::vector<Eigen::Matrix2d> landmark_covariances;
};

/// Least squares over a graph (Levenberg-Marquardt, Ceres Solver, one thread). From raw odometry the poses
/// are added in blocks and all is optimised after each block, which keeps a long loop from being closed at
/// the wrong end (Kaess et al. 2008, without the reuse of the factor). Where poses are given, these are tried
/// first, all at once, and the blocks only if the errors stay larger than their covariances say; the better
/// result is kept. Without a prior and a fixed pose the first pose is held: its covariance is zero.
/// Throws Error{input} for a graph that is empty or falls apart, and for a landmark that is not determined.
GraphSolution optimise(PoseGraph graph, const GraphOptions& options = {});

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/options.hpp"
#include "localization/slam/graph.hpp"
namespace waymark::localization {

/// Options of the least-squares optimisation of a graph.
struct GraphOptions {
  std::int64_t block = 200;       ///< poses added between two optimisations; 0: all at once
  std::int64_t iterations = 100;  ///< limit for the last optimisation
  std::string kernel = "auto";    ///< robust kernel of sightings and loops: none, huber, cauchy; auto: none
  double kernel_width = 2;        ///< standard deviations from which the kernel reduces an error's weight
  bool covariances = true;

  void describe(OptionVisitor& option);
};

/// Result of an optimisation.
struct GraphSolution {
  PoseGraph graph;        ///< with the optimised poses and landmarks
  double chi2 = 0;        ///< sum of squared whitened errors, without kernel
  double start_chi2 = 0;  ///< at the initial poses
  std::size_t residuals = 0, unknowns = 0;
  int iterations = 0, optimisations = 0;
  bool converged = false;
  std::vector<Eigen::Matrix3d> pose_covariances;  ///< x, y, yaw; empty if not requested
  std::vector<Eigen::Matrix2d> landmark_covariances;
};

/// Optimises a graph by least squares (Levenberg-Marquardt, Ceres Solver, one thread). Throws Error{input}
/// for a graph that is empty or not connected, and for a landmark that is not determined.
/// - Without initial poses, poses are added in blocks from odometry, with an optimisation after each block.
///   This keeps a long loop from closing at the wrong end (Kaess et al. 2008, without the reuse of the
///   factor).
/// - Given poses are tried first, all at once. The blocks follow only if the errors stay larger than their
///   covariances; the better result is kept.
/// - Without a prior or a fixed pose the first pose is held constant: its covariance is zero.
GraphSolution optimise(PoseGraph graph, const GraphOptions& options = {});

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/network.hpp"
namespace waymark::pipeline {

struct SolveOptions {
  double cauchy = 0;  ///< width of the Cauchy loss of all terms, standard deviations; 0: plain squares
  int max_iterations = 100;
  double function_tolerance = 1e-14;  ///< relative change of the cost that ends the iterations
};

struct SolveReport {
  bool usable = false, converged = false;
  int iterations = 0;
};

/// Minimises the sum of squared residuals by Levenberg-Marquardt (Ceres), in place. Runs on one thread with
/// Eigen's own arithmetic: the same input gives the same bits.
SolveReport solve(Network& network, const SolveOptions& options);

}  // namespace waymark::pipeline

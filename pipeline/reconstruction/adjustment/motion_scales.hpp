// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/covariance.hpp"
namespace waymark::pipeline {

/// Returns the factors by which the deviations of expected motions must grow to agree with a solution: one
/// step of expectation maximization for their variance (Dempster et al. 1977), which adds the covariance of
/// each residual to its square.
/// - Where the marks say nothing of the motions, the factors are 1.
/// - Images in `left_out`, and those whose squares exceed ten times the median, do not count.
/// - Without expected motions both are 1.
MotionScales motion_scale_changes(const Network& network, const NetworkCovariance& covariance,
                                  const std::vector<bool>& left_out, double sigma0);

}  // namespace waymark::pipeline

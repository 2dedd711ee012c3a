// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/reconstruction/adjustment/covariance.hpp"
#include "pipeline/reconstruction/adjustment/network.hpp"
namespace waymark::pipeline {

/// Residual of a mark, standard deviations; infinite behind the camera.
struct MarkResidual {
  const Term* term = nullptr;
  double size = 0;
};

/// Returns the marks whose residual exceeds the limit that a normal variable exceeds with the same
/// probability at `limit` standard deviations. Scaled by the median residual, so that the given deviations
/// need only be right relative to each other.
std::vector<MarkResidual> outlying_marks(const Network& network, double limit);

/// Returns the marks whose points lie behind the camera.
std::vector<MarkResidual> marks_behind(const Network& network);

/// Returns the statistic of the blunder test of an observation that is not a mark (Baarda 1968): the residual
/// against its own covariance, as a normal variable of the same probability (Wilson & Hilferty 1931). 0 for
/// observations without redundancy. A height above ground counts with its own deviation. Deviations are
/// enlarged by `sigma0` if it is more than 1.
double blunder_statistic(const Network& network, const NetworkCovariance& covariance, const Term& term,
                         double sigma0);

}  // namespace waymark::pipeline

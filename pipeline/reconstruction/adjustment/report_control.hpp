// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/covariance.hpp"
namespace waymark::pipeline {

/// Reports all surveyed points. Positions of check points and of points left out are estimated from their
/// marks by the solved cameras, with the covariance of both.
std::vector<ControlResult> report_control(const Reconstruction& scene, const Observations& observations,
                                          const BuiltNetwork& built, const NetworkCovariance& covariance,
                                          const LeftOut& left_out, double sigma0);

}  // namespace waymark::pipeline

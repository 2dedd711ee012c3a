// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/adjust.hpp"
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/covariance.hpp"
namespace waymark::pipeline {

/// Returns the standard deviation of unit weight of a solved network; 0 without redundancy.
double sigma0_of(const Network& network, int free_datum);

/// Completes the result of a solved network, and writes sigma0 and covariances into the reconstruction.
void report(Reconstruction& scene, const Observations& observations, const BuiltNetwork& built,
            const NetworkCovariance& covariance, const LeftOut& left_out, AdjustmentResult& result);

}  // namespace waymark::pipeline

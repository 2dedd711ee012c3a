// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::importers {

/// Returns false for negative variances and correlations beyond 1. Unknown parts (NaN) are no fault.
bool is_possible_covariance(const Eigen::Matrix3d& covariance);

/// Returns the reason why an imported landmark is implausible; empty if it is plausible.
std::string find_implausibility(const LandmarkType& type, const Landmark& landmark);

}  // namespace waymark::importers

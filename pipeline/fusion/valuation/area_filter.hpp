// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>
#include "core/landmark.hpp"
#include "core/observation.hpp"
namespace waymark::pipeline {

/// Reason for which evidence of landmarks outside the area of interest is rejected.
inline constexpr const char* kOutsideArea = "outside the area of interest";

/// Removes landmarks outside the area of interest and rejects their evidence. Returns their number. They were
/// measured with all the data, so those that remain do not depend on the area.
std::int64_t remove_outside(std::vector<Landmark>& landmarks, std::vector<Observation>& evidence,
                            const std::function<bool(double x, double y)>& in_area);

}  // namespace waymark::pipeline

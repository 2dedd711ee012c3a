// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include "exporters/report/landmark_section.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Returns the first `top` landmarks as an HTML table: position, features with spread, plain attributes,
/// confidence, quality. An attribute `<feature>_low` is a certified lower bound and is shown below its
/// feature if it is smaller.
std::string landmark_table(const LandmarkSection& section, const Crs& crs, std::int64_t top);

}  // namespace waymark::exporters

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include "exporters/report/landmark_section.hpp"
#include "geo/crs.hpp"
namespace waymark {

/// The first `top` landmarks as an HTML table: place, features with spread, plain attributes, quality. An
/// attribute
/// `<feature>_low` is a certified lower bound and stands below its feature where it is smaller.
std::string landmark_table(const LandmarkSection& section, const Crs& crs, std::int64_t top);

}  // namespace waymark

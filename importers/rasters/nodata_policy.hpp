// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "geo/dem_source.hpp"
namespace waymark::importers {

/// Returns "ocean", "unknown" or "fill".
std::string to_string(NodataPolicy policy);

/// Parses a policy. Throws Error{usage} with the nearest name if there is no such policy.
NodataPolicy nodata_policy(std::string_view name);

std::vector<std::string> nodata_policy_names();

}  // namespace waymark::importers

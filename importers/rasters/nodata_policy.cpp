// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/nodata_policy.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr std::array<NodataPolicy, 3> kPolicies = {NodataPolicy::ocean, NodataPolicy::unknown,
                                                   NodataPolicy::fill};

}  // namespace

std::string to_string(NodataPolicy policy) {
  switch (policy) {
    case NodataPolicy::ocean:
      return "ocean";
    case NodataPolicy::unknown:
      return "unknown";
    case NodataPolicy::fill:
      return "fill";
  }
  return {};
}

NodataPolicy nodata_policy(std::string_view name) {
  for (const NodataPolicy policy : kPolicies)
    if (name == to_string(policy)) return policy;
  const std::string nearest = nearest_name(name, nodata_policy_names());
  throw Error(ErrorCode::usage, fmt::format("there is no no-data policy '{}'", name), "",
              nearest.empty() ? "choose ocean, unknown or fill" : fmt::format("did you mean '{}'?", nearest));
}

std::vector<std::string> nodata_policy_names() {
  std::vector<std::string> names;
  for (const NodataPolicy policy : kPolicies) names.push_back(to_string(policy));
  return names;
}

}  // namespace waymark::importers

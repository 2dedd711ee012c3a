// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::importers {

struct HeightUnit {
  double metres = 1;
  bool known = true;
};

/// Returns the unit of a band by any of its usual names, in any case. An empty name means metres.
HeightUnit height_unit(std::string_view name);

/// Returns the unit that a user named. Throws Error{usage} with the names for an unknown one.
HeightUnit stated_height_unit(std::string_view name);

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Returns the creation options of GDAL's PDS4 driver that fill the label's template: "VAR_TARGET=Mars".
/// - Title, target and type of target come from the map, unless `given` ("NAME=VALUE") has them.
/// - `suffix`, "_rock", is appended to the logical identifier, which must differ from file to file.
/// Throws Error{usage} for a name that the template lacks and for an identifier that is no URN.
std::vector<std::string> pds4_label(std::span<const std::string> given, const std::string& title,
                                    const Crs& crs, const std::string& suffix);

}  // namespace waymark::exporters

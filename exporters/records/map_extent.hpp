// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "exporters/records/lonlat_footprint.hpp"
namespace waymark::exporters {

/// Returns the common extent of all layers of a map, elevation tiles included, as the file declares it;
/// `std::nullopt` if they are empty. Throws Error{input} if the file cannot be read.
std::optional<MapBox> map_extent(const std::string& map);

}  // namespace waymark::exporters

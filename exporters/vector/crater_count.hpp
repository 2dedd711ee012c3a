// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "exporters/vector/export_map.hpp"
namespace waymark::exporters {

/// Returns true for the file names of craterstats: .scc (craters with positions and the outline of the area)
/// and .diam (diameters and an area).
bool is_crater_count(const std::string& out);

/// Writes the craters of a map for craterstats (Michael & Neukum 2010; formats of craterstats 3): kilometres,
/// degrees of longitude (-180 to 180) and latitude, the counting area in km2.
/// - The area is that of the options, else counting_area(). The outline is written if it is known.
/// - Craters without a size and craters whose centre lies outside the outline are left out, with a warning.
/// Throws Error if the map has no craters, the area is unknown, or the output exists; also for a .scc of a
/// map on no body.
ExportSummary export_crater_count(const std::filesystem::path& map, const std::string& out,
                                  const ExportOptions& options);

}  // namespace waymark::exporters

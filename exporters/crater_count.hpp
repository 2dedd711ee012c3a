// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "exporters/export_map.hpp"
namespace waymark {

/// True for the names craterstats reads: .scc (craters with places and the outline of the area) and .diam
/// (diameters and an area).
bool is_crater_count(const std::string& out);

/// Writes the craters of a map as craterstats reads them (Michael & Neukum 2010; formats of craterstats 3):
/// kilometres, degrees of longitude (-180 to 180) and latitude, the counting area in km2. The area is that of
/// the options, else count_area(). An outline is written where it is known. Craters whose centre lies outside
/// it are left out, with a warning; those without a size too. Throws Error: no craters in the map, no area
/// known, a .scc of a map on no body, an output that exists.
ExportSummary export_crater_count(const std::filesystem::path& map, const std::string& out,
                                  const ExportOptions& options);

}  // namespace waymark

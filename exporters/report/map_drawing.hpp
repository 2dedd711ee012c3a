// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// Returns the map as an HTML figure: relief if a DEM is available, landmarks, graticule, scale bar, north
/// arrow, legend.
std::string map_figure(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                       std::int64_t relief_pixels);

/// Returns the files that may hold the relief: the DEM in the map, else the inputs of its runs, at their
/// recorded paths and beside the map.
std::vector<std::string> relief_names(const geodb::MapStore& map);

}  // namespace waymark::exporters

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark {

/// Refuses, before any work is done, an output that cannot become a map. Throws Error: its name does not end
/// in .gpkg, its folder is missing or cannot be written, it is there but is not a Waymark map.
void check_map_output(const std::filesystem::path& map);

}  // namespace waymark

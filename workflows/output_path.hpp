// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark::workflows {

/// Throws Error for an output that cannot become a map: its name does not end in .gpkg, its folder is missing
/// or read-only, or it exists and is not a Waymark map. Call it before any work is done.
void check_map_output(const std::filesystem::path& map);

}  // namespace waymark::workflows

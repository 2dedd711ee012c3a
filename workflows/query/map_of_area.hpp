// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>
#include "core/locked_folder.hpp"
namespace waymark::workflows {

/// A map, or the part of it inside an area of interest and of sufficient confidence, for commands that read a
/// map.
/// - Without either it is the map itself.
/// - Else it is what `waymark export MAP PART.gpkg --aoi AREA --min-confidence P` writes, under the name of
///   the map.
/// - The part lies in a folder beside `output`, which lives as long as this object.
class MapOfArea {
 public:
  /// `aoi`: file of polygons in any CRS of the body, or empty. Throws Error{input} as
  /// importers::read_area_of_interest(), and if no landmark is left. `min_confidence`: 0 to 1.
  MapOfArea(const std::string& map, const std::string& aoi, const std::filesystem::path& output,
            double min_confidence = 0);

  const std::string& path() const { return path_; }
  /// Returns what the part lacks, one sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::unique_ptr<LockedFolder> folder_;
  std::string path_;
  std::vector<std::string> warnings_;
};

/// Returns the DEM inside a map as GDAL names it; empty if the map has none. The part of an area has none.
std::vector<std::string> dem_of_map(const std::string& map);

/// Writes the part of a map inside the area to `output`, and returns its number of landmarks. Throws as
/// MapOfArea does.
std::int64_t write_part_of_map(const std::filesystem::path& map, const std::string& aoi,
                               const std::filesystem::path& output, std::vector<std::string>& warnings,
                               double min_confidence = 0);

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "workflows/query/map_of_area.hpp"

#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/vector/export_map.hpp"
#include "geodb/map_store.hpp"
#include "workflows/query/area_of_map.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<LockedFolder> folder_beside(const fs::path& output) try {
  const fs::path parent = output.parent_path();
  return std::make_unique<LockedFolder>(parent.empty() ? fs::path(".") : parent);
} catch (const fs::filesystem_error& e) {
  fail_output(output, e.code().message());
}

}  // namespace

std::vector<std::string> dem_of_map(const std::string& map) {
  if (!geodb::MapStore::open(map).has_dem_coverage()) return {};
  return {"GPKG:" + map + ":dem"};
}

std::int64_t write_part_of_map(const fs::path& map, const std::string& aoi, const fs::path& output,
                               std::vector<std::string>& warnings) {
  const MapArea area = area_of_map(aoi, map);
  const exporters::ExportSummary done = exporters::export_map(
      map, output.string(), {.driver = "GPKG", .inside = area.contains, .overwrite = true});
  std::int64_t landmarks = 0;
  for (const exporters::ExportedLayer& layer : done.layers) landmarks += layer.landmarks;
  if (landmarks == 0)
    throw Error(ErrorCode::input, "no landmark of the map lies in the area of interest", aoi,
                "check the CRS of the area, and that it is drawn on this map: " + map.string());
  warnings.insert(warnings.end(), done.warnings.begin(), done.warnings.end());
  return landmarks;
}

MapOfArea::MapOfArea(const std::string& map, const std::string& aoi, const fs::path& output) : path_(map) {
  if (aoi.empty()) return;
  folder_ = folder_beside(output);
  path_ = (folder_->path() / (fs::path(map).stem().string() + ".gpkg")).string();
  write_part_of_map(map, aoi, path_, warnings_);
}

}  // namespace waymark::workflows

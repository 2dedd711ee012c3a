// SPDX-License-Identifier: Apache-2.0
#include "workflows/query/map_of_area.hpp"

#include <fmt/format.h>

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

[[noreturn]] void fail_empty(const fs::path& map, const std::string& aoi, double min_confidence) {
  const std::string of_confidence =
      min_confidence > 0 ? fmt::format(" of confidence {:g} or more", min_confidence) : "";
  if (aoi.empty())
    throw Error(ErrorCode::input, "the map has no landmark" + of_confidence, map.string(),
                "lower --min-confidence");
  throw Error(ErrorCode::input,
              fmt::format("no landmark of the map{} lies in the area of interest", of_confidence), aoi,
              "check the CRS of the area, and that it is drawn on this map: " + map.string());
}

}  // namespace

std::vector<std::string> dem_of_map(const std::string& map) {
  if (!geodb::MapStore::open(map).has_dem_coverage()) return {};
  return {"GPKG:" + map + ":dem"};
}

std::int64_t write_part_of_map(const fs::path& map, const std::string& aoi, const fs::path& output,
                               std::vector<std::string>& warnings, double min_confidence) {
  exporters::ExportOptions options{.driver = "GPKG", .min_confidence = min_confidence, .overwrite = true};
  if (!aoi.empty()) options.inside = area_of_map(aoi, map).contains;
  const exporters::ExportSummary done = exporters::export_map(map, output.string(), options);
  std::int64_t landmarks = 0;
  for (const exporters::ExportedLayer& layer : done.layers) landmarks += layer.landmarks;
  if (landmarks == 0) fail_empty(map, aoi, min_confidence);
  warnings.insert(warnings.end(), done.warnings.begin(), done.warnings.end());
  return landmarks;
}

MapOfArea::MapOfArea(const std::string& map, const std::string& aoi, const fs::path& output,
                     double min_confidence)
    : path_(map) {
  if (aoi.empty() && !(min_confidence > 0)) return;
  folder_ = folder_beside(output);
  path_ = (folder_->path() / (fs::path(map).stem().string() + ".gpkg")).string();
  write_part_of_map(map, aoi, path_, warnings_, min_confidence);
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "apps/write_detections.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <filesystem>

#include "apps/log.hpp"
#include "apps/output_path.hpp"
#include "apps/provenance.hpp"
#include "apps/registries.hpp"
#include "core/error.hpp"
#include "exporters/aside_folder.hpp"
#include "geodb/write_map.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::system_clock;

void write_text(const std::string& output, const std::string& text) {
  if (!output.starts_with("/vsi")) return write_file(output, text);
  VSILFILE* file = VSIFOpenL(output.c_str(), "wb");
  if (file == nullptr) fail_output(output, "GDAL cannot write there");
  const bool written = VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
  if (VSIFCloseL(file) != 0 || !written) fail_output(output, "GDAL could not write all of it");
}

RunRecord record_of(const ImageDetections& found, const std::string& path, const Session& session,
                    Clock::time_point started) {
  StageReport stage;
  stage.stage = fmt::format("detect_{}s", all_types()[found.type].name);
  stage.units = stage.made = 1;
  stage.counts.in = stage.counts.out = static_cast<std::int64_t>(found.detections.size());
  return record_of_one(std::move(stage), path, session, started);
}

}  // namespace

void check_detection_output(const std::string& output) {
  const fs::path path(output);
  if (path.extension() == ".gpkg") return check_map_output(path);
  const bool known =
      path.extension() == ".csv" || path.extension() == ".geojson" || path.extension() == ".json";
  if (!known)
    throw Error(ErrorCode::usage, "detections are written as .csv, .geojson or .gpkg", output,
                "e.g. -o " + fs::path(path).replace_extension(".csv").string());
  if (output.starts_with("/vsi")) return;
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::output, "the folder of the output does not exist: " + folder.string(), output,
                "make it with: mkdir -p " + folder.string());
  if (fs::is_directory(path))
    throw Error(ErrorCode::output, "the output is a folder", output,
                "name a file in it: -o " + (path / "detections.csv").string());
}

void write_detections(const std::string& output, const ImageDetections& found, const std::string& path,
                      const Session& session, Clock::time_point started) {
  const LandmarkType& type = all_types()[found.type];
  const std::string ending = fs::path(output).extension().string();
  if (ending == ".csv") return write_text(output, detections_as_csv(found, type));
  if (ending != ".gpkg") return write_text(output, detections_as_geojson(found, type));
  if (!found.place && !found.gsd)
    log_warning("the size of a pixel is not known: in the map a pixel counts as a metre; pass --gsd");
  MapContents contents = detections_as_map(found, all_types());
  contents.run = record_of(found, path, session, started);
  write_map(output, contents, {.empty_tables = {type.name}});
}

}  // namespace waymark

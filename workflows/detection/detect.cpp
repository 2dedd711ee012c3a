// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/detect.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/output_error.hpp"
#include "geodb/write_map.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "workflows/detection/detection_plan.hpp"
#include "workflows/output_path.hpp"
#include "workflows/provenance.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

// Where detections are written, and what a map records about their origin.
struct DetectionOutput {
  std::string path;
  std::string kind;   // name of the detector
  std::string image;  // file that was searched
  std::string command_line;
  std::int64_t outside = 0;  // detections outside the area of interest
  std::chrono::system_clock::time_point started;
};

void write_text(const std::string& output, const std::string& text) {
  if (!output.starts_with("/vsi")) return write_file(output, text);
  VSILFILE* file = VSIFOpenL(output.c_str(), "wb");
  if (file == nullptr) fail_output(output, "GDAL cannot write there");
  const bool written = VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
  if (VSIFCloseL(file) != 0 || !written) fail_output(output, "GDAL could not write all of it");
}

geodb::RunRecord run_record(const exporters::ImageDetections& found, const DetectionOutput& output) {
  pipeline::StageReport stage;
  stage.stage = "detect_" + output.kind;
  stage.units = stage.made = 1;
  stage.counts.out = static_cast<std::int64_t>(found.detections.size());
  stage.counts.in = stage.counts.out + output.outside;
  if (output.outside > 0) stage.counts.rejected[importers::kOutsideArea] = output.outside;
  return make_single_step_record(std::move(stage), output.image, output.command_line, output.started);
}

// Throws Error for an output whose name ends in none of .csv, .geojson, .json, .gpkg, or whose folder cannot
// be written.
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

/// Returns the area of the request in the CRS of the image. Throws Error for an image without georeference
/// and an area that does not meet it.
std::optional<importers::Area> area_of(const DetectRequest& request, const ImageInfo& image) {
  if (request.aoi.empty()) return {};
  if (!image.ortho)
    throw Error(ErrorCode::usage, "the image has no position on the ground, so no area of interest applies",
                image.path, "leave --aoi out, or give a georeferenced image in metres");
  importers::Area area = importers::read_area_of_interest(request.aoi, image.crs);
  GridGeometry grid{.columns = image.columns, .rows = image.rows, .where = *image.ortho};
  grid.where.crs = image.crs;
  importers::check_area_meets(area, grid, "the image", request.aoi);
  return area;
}

/// Drops the detections whose centres lie outside. Returns their number.
std::int64_t keep_inside(const importers::Area& area, exporters::ImageDetections& found) {
  std::vector<Detection> kept;
  std::vector<FeatureSet> features;
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    const PixelEllipse& outline = found.detections[i].outline;
    if (!area.contains(found.georeference->x(outline.x), found.georeference->y(outline.y))) continue;
    kept.push_back(found.detections[i]);
    if (!found.features.empty()) features.push_back(found.features[i]);
  }
  const std::size_t dropped = found.detections.size() - kept.size();
  found.detections = std::move(kept);
  found.features = std::move(features);
  return static_cast<std::int64_t>(dropped);
}

// Writes detections in the format of the output's extension; a GeoPackage with the record of this run.
void write_detections(const exporters::ImageDetections& found, const DetectionOutput& output,
                      const Callbacks& callbacks) {
  const LandmarkType& type = all_types()[found.type];
  const std::string extension = fs::path(output.path).extension().string();
  if (extension == ".csv") return write_text(output.path, exporters::detections_to_csv(found, type));
  if (extension != ".gpkg") return write_text(output.path, exporters::detections_to_geojson(found, type));
  if (!found.georeference && !found.gsd)
    callbacks.warning("the size of a pixel is not known: in the map a pixel counts as a metre; pass --gsd");
  geodb::MapContents contents = exporters::detections_to_map(found, all_types());
  contents.run = run_record(found, output);
  geodb::write_map(output.path, contents, {.empty_tables = {type.name}});
}

}  // namespace

DetectResult detect(const DetectRequest& request, const Callbacks& callbacks) {
  PlannedDetection planned = plan_detection(request);
  DetectionPlan& plan = planned.plan;
  if (!request.output.empty()) check_detection_output(request.output);
  std::vector<std::string> inputs{request.image, request.aoi};
  for (const auto& [name, text] : request.settings) inputs.push_back(text);  // some name a file
  keep_inputs(request.output, inputs);
  const std::optional<importers::Area> area = area_of(request, plan.image->info());
  const auto started = std::chrono::system_clock::now();
  for (const std::string& warning : plan.warnings) callbacks.warning(warning);
  plan.search.progress = callbacks.progress;
  DetectResult found = planned.detector.find(plan);
  if (area) found.outside = keep_inside(*area, found.detections);
  for (const std::string& warning : found.warnings) callbacks.warning(warning);
  found.warnings.insert(found.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
  if (!found.light.empty()) callbacks.summary(found.light + "\n");
  if (request.output.empty()) return found;
  const DetectionOutput output{request.output,       planned.spec.name, plan.image->info().path,
                               request.command_line, found.outside,     started};
  write_detections(found.detections, output, callbacks);
  callbacks.summary(fmt::format("{}: {} {}{}\n", request.output, found.detections.detections.size(),
                                request.kind,
                                area ? fmt::format(", {} outside the area of interest", found.outside) : ""));
  return found;
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/export_map.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/output_error.hpp"
#include "exporters/vector/crater_count.hpp"
#include "exporters/vector/export_check.hpp"
#include "exporters/vector/map_subset.hpp"
#include "exporters/vector/ogr_output.hpp"
#include "exporters/vector/pds4_label.hpp"
#include "exporters/vector/reproject.hpp"
#include "exporters/vector/vector_format.hpp"
#include "geodb/map_store.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

/// State shared by the steps of one export.
struct Export {
  const geodb::MapStore& map;
  VectorFormat format;
  const Crs crs;
  std::function<bool(double, double)> inside;
  double min_confidence;
  ExportSummary summary;

  void warn(std::vector<std::string> texts) {
    for (std::string& text : texts)
      if (std::find(summary.warnings.begin(), summary.warnings.end(), text) == summary.warnings.end())
        summary.warnings.push_back(std::move(text));
  }
};

/// Wraps longitudes to -180..180 as RFC 7946 and KML require; maps across the antimeridian or of 0..360
/// exceed it.
void wrap_longitudes(std::vector<Landmark>& landmarks) {
  for (Landmark& l : landmarks) l.position.xyz.x() = std::remainder(l.position.xyz.x(), 360);
}

/// Landmarks of a type in the CRS of the export.
class TypeReader {
 public:
  TypeReader(const Export& job, const LandmarkType& type) : job_(&job), type_(&type) {}

  /// Visits the landmarks in order of storage, some thousands in memory at a time.
  void visit(const std::function<void(const Landmark&)>& visit) {
    constexpr std::size_t kAtOnce = 10'000;
    std::vector<Landmark> some;
    written = lost = 0;
    const auto flush = [&] {
      Reprojected found = reproject(std::move(some), *type_, job_->map.crs(), job_->crs);
      some.clear();
      if (job_->format.earth_only && job_->crs.kind() == CrsKind::geographic)
        wrap_longitudes(found.landmarks);
      lost += found.lost;
      written += static_cast<std::int64_t>(found.landmarks.size());
      for (const Landmark& landmark : found.landmarks) visit(landmark);
    };
    job_->map.visit(type_->name, [&](Landmark&& landmark) {
      const Eigen::Vector3d& at = landmark.position.xyz;
      if (job_->inside && !job_->inside(at.x(), at.y())) return;
      if (job_->min_confidence > 0 && !(landmark.confidence >= job_->min_confidence)) return;
      some.push_back(std::move(landmark));
      if (some.size() == kAtOnce) flush();
    });
    flush();
  }

  std::int64_t written = 0, lost = 0;  ///< of the last visit

 private:
  const Export* job_;
  const LandmarkType* type_;
};

/// Bounds what GDAL holds of a format until the file is closed. Throws Error{usage} if a layer has too many
/// landmarks for the format.
void bound_memory(Export& job, const std::vector<std::string>& types, const std::string& out,
                  std::int64_t max_megabytes) {
  std::int64_t landmarks = 0, in_layer = 0;
  for (const std::string& type : types) {
    landmarks += job.map.count(type);
    in_layer = std::max(in_layer, job.map.count(type));
  }
  if (job.format.max_landmarks > 0 && in_layer > job.format.max_landmarks)
    throw Error(ErrorCode::usage,
                fmt::format("a sheet of {} holds {} landmarks, the map has {}", job.format.driver,
                            job.format.max_landmarks, in_layer),
                out, "write .csv, .gpkg or .fgb, which have no limit");
  const std::int64_t megabytes = landmarks * job.format.bytes_per_landmark / 1'000'000;
  job.format.has_index = megabytes <= max_megabytes;
  if (job.format.has_index) return;
  job.warn(
      {job.format.driver == "FlatGeobuf"
           ? fmt::format("FlatGeobuf: no spatial index, for which GDAL would take {} MB; --memory allows "
                         "more, .gpkg has an index",
                         megabytes)
           : fmt::format("{}: GDAL holds the whole file, about {} MB; .csv, .gpkg and .geojson are "
                         "written in pieces",
                         job.format.driver, megabytes)});
}

void write_layers(Export& job, const std::vector<std::string>& types, const std::string& path,
                  const std::string& out) {
  OgrOutput output(job.format, path, out);
  for (const std::string& name : types) {
    const LandmarkType& type = *job.map.types().find(name);
    TypeReader reader(job, type);
    output.add_layer(
        type, [&](const auto& visit) { reader.visit(visit); }, job.crs);
    if (reader.lost > 0)
      job.warn({fmt::format("{} of {} {} landmarks have no position in {} and are left out", reader.lost,
                            job.map.count(name), name, job.crs.id())});
    job.summary.layers.push_back({name, reader.written});
  }
  job.warn(output.close());
}

void write_aside_first(Export& job, const std::vector<std::string>& types, const fs::path& out) {
  AtomicFileSet aside(folder_of(out), out);
  const std::string path = (aside.path() / out.filename()).string();
  const std::size_t before = job.summary.layers.size();
  write_layers(job, types, path, out.string());
  std::int64_t landmarks = 0;
  for (std::size_t i = before; i < job.summary.layers.size(); ++i)
    landmarks += job.summary.layers[i].landmarks;
  job.warn(check_export(job.format, path, out.string(), job.crs, landmarks));
  for (const fs::path& file : aside.commit()) job.summary.files.push_back(file.string());
}

void refuse_existing(const std::string& out, bool overwrite) {
  VSIStatBufL status;
  if (out.starts_with("/vsistdout") || VSIStatL(out.c_str(), &status) != 0) return;
  if (!overwrite)
    throw Error(ErrorCode::output, fmt::format("{} exists already", fs::path(out).filename().string()), out,
                "remove it, choose another name, or allow it to be replaced with --overwrite");
  if (VSI_ISDIR(status.st_mode) && !out.ends_with(".gdb")) fail_output(out, "it is a folder");
}

std::vector<std::string> chosen_types(const geodb::MapStore& map, const std::vector<std::string>& asked) {
  std::vector<std::string> types;
  for (const std::string& type : asked.empty() ? map.types().names() : asked) {
    static_cast<void>(map.count(type));  // throws for a type that the map lacks
    if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
  }
  return types;
}

/// Returns one file for all types, or one each if the format holds a single layer.
struct OutputFile {
  std::string path;
  std::vector<std::string> types;
};

std::vector<OutputFile> output_files(const VectorFormat& format, const std::string& out,
                                     const std::vector<std::string>& types) {
  if (!format.is_file || !format.one_layer || types.size() == 1) return {{out, types}};
  const fs::path path(out);
  std::vector<OutputFile> files;
  for (const std::string& type : types)
    files.push_back(
        {(path.parent_path() / fmt::format("{}_{}{}", path.stem().string(), type, path.extension().string()))
             .string(),
         {type}});
  return files;
}

constexpr std::size_t kLandmarksInMemory = 10'000;  // 1 to 2 kB each

void write_map_file(Export& job, const std::vector<std::string>& types, const fs::path& out) {
  geodb::check_before_copy(job.map.path());
  const LandmarkChoice chosen{types, job.inside, job.min_confidence};
  MapSubset subset = map_subset(job.map, chosen, job.crs);
  subset.contents.layers = subset_layers(job.map, chosen, job.crs, subset.warnings);
  geodb::write_map(out, subset.contents,
                   {.empty_tables = types, .max_landmarks_in_memory = kLandmarksInMemory});
  job.summary.layers = std::move(subset.layers);
  job.summary.files = {out.string()};
  job.warn(std::move(subset.warnings));
}

constexpr std::string_view kPds4 = "PDS4";

std::string label_title(const std::vector<std::string>& types, const fs::path& map) {
  return fmt::format("Landmarks of {}: {}", map.stem().string(), fmt::join(types, ", "));
}

}  // namespace

ExportSummary export_map(const fs::path& map_path, const std::string& out, const ExportOptions& options) {
  keep_inputs(out, {map_path.string()});
  if (options.driver.empty() && is_crater_count(out)) return export_crater_count(map_path, out, options);
  const VectorFormat format = vector_format(out, options.driver);
  if (!options.label.empty() && format.driver != kPds4)
    throw Error(ErrorCode::usage, format.driver + " has no label", "--label", "PDS4 has one: -of PDS4");
  if (options.area_km2 != 0)
    throw Error(ErrorCode::usage, format.driver + " has no counting area", "--area",
                "crater counts have one: OUT.scc or OUT.diam");
  const geodb::MapStore map = geodb::MapStore::open(map_path);
  const auto types = chosen_types(map, options.types);
  Export job{map,
             format,
             output_crs(format, map.crs(), options.crs, map_path.string()),
             options.inside,
             options.min_confidence,
             {}};
  job.summary.driver = format.driver;
  job.summary.crs = job.crs.id();

  if (format.driver != "GPKG") geodb::check_before_reading(map_path);
  const auto files = output_files(format, out, types);
  if (format.is_file)
    for (const OutputFile& file : files) refuse_existing(file.path, options.overwrite);
  for (const OutputFile& file : files) {
    bound_memory(job, file.types, file.path, options.max_megabytes);
    if (format.driver == kPds4)
      job.format.creation_options = pds4_label(options.label, label_title(file.types, map_path), job.crs,
                                               files.size() > 1 ? "_" + file.types.front() : "");
    if (format.driver == "GPKG")
      write_map_file(job, file.types, file.path);
    else if (!format.is_file || file.path.starts_with("/vsi"))
      write_layers(job, file.types, file.path, file.path);
    else
      write_aside_first(job, file.types, file.path);
  }
  return std::move(job.summary);
}

}  // namespace waymark::exporters

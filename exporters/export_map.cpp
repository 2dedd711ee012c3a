// SPDX-License-Identifier: Apache-2.0
#include "exporters/export_map.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "exporters/aside_folder.hpp"
#include "exporters/crater_count.hpp"
#include "exporters/export_check.hpp"
#include "exporters/map_subset.hpp"
#include "exporters/ogr_output.hpp"
#include "exporters/reproject.hpp"
#include "exporters/vector_format.hpp"
#include "geodb/map_store.hpp"
#include "geodb/write_map.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// Everything the steps of one export share.
struct Export {
  const MapStore& map;
  const VectorFormat format;
  const Crs crs;
  ExportSummary summary;

  void warn(std::vector<std::string> texts) {
    for (std::string& text : texts)
      if (std::find(summary.warnings.begin(), summary.warnings.end(), text) == summary.warnings.end())
        summary.warnings.push_back(std::move(text));
  }
};

/// RFC 7946 and KML count longitudes from -180 to 180; a map across the antimeridian or of 0..360 does not.
void wrap_longitudes(std::vector<Landmark>& landmarks) {
  for (Landmark& l : landmarks) l.position.xyz.x() = std::remainder(l.position.xyz.x(), 360);
}

std::vector<Landmark> landmarks_of(Export& job, const LandmarkType& type) {
  Reprojected found = reproject(job.map.query({.types = {type.name}}), type, job.map.crs(), job.crs);
  if (job.format.earth_only && job.crs.kind() == CrsKind::geographic) wrap_longitudes(found.landmarks);
  if (found.lost > 0)
    job.warn({fmt::format("{} of {} {} landmarks have no position in {} and are left out", found.lost,
                          job.map.count(type.name), type.name, job.crs.id())});
  job.summary.layers.push_back({type.name, static_cast<std::int64_t>(found.landmarks.size())});
  return std::move(found.landmarks);
}

void write_layers(Export& job, const std::vector<std::string>& types, const std::string& path,
                  const std::string& out) {
  OgrOutput output(job.format, path, out);
  for (const std::string& type : types)
    output.add_layer(*job.map.types().find(type), landmarks_of(job, *job.map.types().find(type)), job.crs);
  job.warn(output.close());
}

void write_aside(Export& job, const std::vector<std::string>& types, const fs::path& out) {
  AsideFolder aside(out);
  const std::string path = (aside.path() / out.filename()).string();
  const std::size_t before = job.summary.layers.size();
  write_layers(job, types, path, out.string());
  std::int64_t landmarks = 0;
  for (std::size_t i = before; i < job.summary.layers.size(); ++i)
    landmarks += job.summary.layers[i].landmarks;
  job.warn(check_export(job.format, path, out.string(), job.crs, landmarks));
  for (const fs::path& file : aside.publish()) job.summary.files.push_back(file.string());
}

void refuse_existing(const std::string& out, bool overwrite) {
  VSIStatBufL status;
  if (out.starts_with("/vsistdout") || VSIStatL(out.c_str(), &status) != 0) return;
  if (!overwrite)
    throw Error(ErrorCode::output, fmt::format("{} exists already", fs::path(out).filename().string()), out,
                "remove it, choose another name, or allow it to be replaced with --overwrite");
  if (VSI_ISDIR(status.st_mode) && !out.ends_with(".gdb")) fail_output(out, "it is a folder");
}

std::vector<std::string> chosen_types(const MapStore& map, const std::vector<std::string>& asked) {
  std::vector<std::string> types;
  for (const std::string& type : asked.empty() ? map.types().names() : asked) {
    static_cast<void>(map.types().id(type));  // throws with the nearest name
    if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
  }
  return types;
}

/// One file for all types, or one each where the format holds a single layer.
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

void write_map_file(Export& job, const std::vector<std::string>& types, const fs::path& out) {
  MapSubset subset = map_subset(job.map, types, job.crs);
  write_map(out, subset.contents, {.empty_tables = types});
  job.summary.layers = std::move(subset.layers);
  job.summary.files = {out.string()};
  job.warn(std::move(subset.warnings));
}

}  // namespace

ExportSummary export_map(const fs::path& map_path, const std::string& out, const ExportOptions& options) {
  if (options.driver.empty() && is_crater_count(out)) return export_crater_count(map_path, out, options);
  const VectorFormat format = vector_format(out, options.driver);
  const MapStore map = MapStore::open(map_path);
  const auto types = chosen_types(map, options.types);
  Export job{map, format, output_crs(format, map.crs(), options.crs, map_path.string()), {}};
  job.summary.driver = format.driver;
  job.summary.crs = job.crs.id();

  const auto files = output_files(format, out, types);
  if (format.is_file)
    for (const OutputFile& file : files) refuse_existing(file.path, options.overwrite);
  for (const OutputFile& file : files) {
    if (format.driver == "GPKG")
      write_map_file(job, file.types, file.path);
    else if (!format.is_file || file.path.starts_with("/vsi"))
      write_layers(job, file.types, file.path, file.path);
    else
      write_aside(job, file.types, file.path);
  }
  return std::move(job.summary);
}

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/camera_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/place_cameras.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {

void register_camera_formats(CameraFormats& formats);  // generated from the folder formats

namespace {

const std::vector<CameraFormat>& formats() {
  static const CameraFormats all = [] {
    CameraFormats made;
    register_camera_formats(made);
    return made;
  }();
  return all.all();
}

const CameraFormat& named(const std::string& name) {
  const auto found = std::ranges::find(formats(), name, &CameraFormat::name);
  if (found != formats().end()) return *found;
  const std::string near = nearest_name(name, camera_formats());
  throw Error(ErrorCode::usage,
              fmt::format("there is no camera format '{}'{}", name,
                          near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
              "", fmt::format("formats: {}", fmt::join(camera_formats(), ", ")));
}

const CameraFormat& recognised(const CameraSource& source) {
  for (const CameraFormat& format : formats())
    if (format.recognises(source)) return format;
  throw Error(ErrorCode::input, "the camera file is of no known format", source.path,
              fmt::format("formats: {}; select one with the option camera_format",
                          fmt::join(camera_formats(), ", ")));
}

// COLMAP's models are folders.
std::string head_of_source(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? "" : read_vsi_head(path);
}

// Counts the path components that both have in common from the end; 0 unless the file names agree.
std::size_t common_end(const std::filesystem::path& name, const std::filesystem::path& file) {
  const bool same_file =
      name.filename() == file.filename() || name.filename() == file.stem() || name.stem() == file.stem();
  if (!same_file) return 0;
  const std::filesystem::path a = name.parent_path(), b = file.parent_path();
  std::size_t same = name.filename() == file.filename() ? 2 : 1;
  for (auto i = a.end(), j = b.end(); i != a.begin() && j != b.begin() && *--i == *--j;) same += 2;
  return same;
}

}  // namespace

std::vector<std::string> camera_formats() {
  std::vector<std::string> names;
  for (const CameraFormat& format : formats()) names.push_back(format.name);
  return names;
}

CameraSet import_cameras(const std::string& path, const std::string& format, const CameraImport& import) {
  const CameraSource source{.path = path, .head = head_of_source(path), .interior = import.interior};
  const CameraFormat& reader = format.empty() ? recognised(source) : named(format);
  try {
    CameraSet set = place_cameras(reader.read(source), path, import);
    set.format = reader.name;
    return set;
  } catch (const Error& error) {  // of a value of the file, such as its CRS
    if (error.where().find(path) != std::string::npos) throw;
    throw Error(error.code(), error.problem(),
                error.where().empty() ? path : fmt::format("{}, at {}", path, error.where()), error.hint());
  }
}

std::vector<Camera> import_lenses(const std::string& path) {
  const CameraSource source{.path = path, .head = head_of_source(path), .interior = {}};
  std::vector<Camera> lenses;
  for (const CameraRecord& image : recognised(source).read(source).images) {
    if (!image.camera || image.camera->columns <= 0) continue;
    Camera camera = *image.camera;
    if (std::isnan(camera.cx)) camera.cx = double(camera.columns - 1) / 2;
    if (std::isnan(camera.cy)) camera.cy = double(camera.rows - 1) / 2;
    if (std::ranges::find(lenses, camera) == lenses.end()) lenses.push_back(camera);
  }
  if (lenses.empty())
    throw Error(ErrorCode::input, "the camera file has no lens with its image size", path,
                "name a camera file of the same camera, e.g. cameras.json of an earlier reconstruction");
  return lenses;
}

const ImageCamera* find_camera(const CameraSet& set, const std::string& image_file) {
  const ImageCamera* best = nullptr;
  std::size_t best_same = 0;
  for (const ImageCamera& image : set.images) {
    const std::size_t same = common_end(image.image, image_file);
    if (same == best_same) best = nullptr;
    if (same <= best_same) continue;
    best_same = same;
    best = &image;
  }
  return best;
}

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/camera_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/interior_orientation.hpp"
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

// Returns the entry with most path components in common; null if two agree equally.
template <class Entry>
const Entry* best_match(const std::vector<Entry>& all, const std::string& image_file) {
  const Entry* best = nullptr;
  std::size_t best_same = 0;
  for (const Entry& image : all) {
    const std::size_t same = common_end(image.image, image_file);
    if (same == best_same) best = nullptr;
    if (same <= best_same) continue;
    best_same = same;
    best = &image;
  }
  return best;
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

KnownLenses import_lenses(const std::string& path) {
  const CameraSource source{.path = path, .head = head_of_source(path), .interior = {}};
  KnownLenses known;
  const auto add = [&](Camera camera, double readout_time) {
    if (std::isnan(camera.cx)) camera.cx = (double(camera.columns) - 1) / 2;
    if (std::isnan(camera.cy)) camera.cy = (double(camera.rows) - 1) / 2;
    const KnownLens lens{.camera = camera, .readout_time = readout_time};
    const auto at = std::ranges::find(known.lenses, lens) - known.lenses.begin();
    if (at == std::ssize(known.lenses)) known.lenses.push_back(lens);
    return static_cast<std::size_t>(at);
  };
  const auto format =
      std::ranges::find_if(formats(), [&](const CameraFormat& f) { return f.recognises(source); });
  if (format == formats().end()) {
    for (const auto& [name, camera] : read_interior(path)) add(camera, 0);
    return known;
  }
  const CameraFile file = format->read(source);
  for (const CameraRecord& image : file.images) {
    KnownLenses::Entry& entry = known.images.emplace_back();
    entry.image = image.image;
    entry.taken_utc = image.taken_utc;
    if (image.camera && image.camera->columns > 0) entry.lens = add(*image.camera, image.readout_time);
  }
  for (const LensRecord& lens : file.lenses) add(lens.camera, lens.readout_time);
  if (known.lenses.empty())
    throw Error(ErrorCode::input, "the camera file has no lens with its image size", path,
                "name a camera file of the same camera, e.g. cameras.json of an earlier reconstruction");
  return known;
}

const KnownLenses::Entry* find_entry(const KnownLenses& known, const std::string& image_file) {
  return best_match(known.images, image_file);
}

const ImageCamera* find_camera(const CameraSet& set, const std::string& image_file) {
  return best_match(set.images, image_file);
}

}  // namespace waymark::importers

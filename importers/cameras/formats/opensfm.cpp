// SPDX-License-Identifier: Apache-2.0
// OpenSfM and OpenDroneMap: reconstruction.json.
//  - shot.rotation is an angle-axis vector, world to camera; shot.translation is t in X_camera = R X_world
//    + t.
//  - OpenSfM's world is east, north, up about reference_lla; without one it is arbitrary.
//  - OpenDroneMap rotates the same file into the axes of a UTM zone, less a whole number of metres, and
//    moves reference_lla to that origin. The difference is the meridian convergence, up to 3 deg: a
//    reference that lies on whole metres of its zone within 2 mm is taken for OpenDroneMap's.
//  - capture_time is EXIF's local time counted as if it were UTC: it is not used.
#include <fmt/format.h>

#include <cmath>

#include "core/solve.hpp"
#include "geo/crs.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/interior_orientation.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

Eigen::Isometry3d world_from_shot(const JsonValue& shot) {
  const Eigen::Vector3d t = shot["translation"].vector3();
  const Eigen::Matrix3d camera_from_world = rotation_by(shot["rotation"].vector3());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = camera_from_world.transpose();
  pose.translation() = -(camera_from_world.transpose() * t);
  return pose;
}

void set_world(const JsonValue& lla, CameraFile& file) {
  const double lon = lla["longitude"].number(), lat = lla["latitude"].number(),
               height = lla["altitude"].number();
  const std::string zone = utm_zone(lon, lat);
  const auto [x, y] = CrsTransform(Crs::from_text("EPSG:4326"), Crs::from_text(zone))(lon, lat);
  constexpr double kWhole = 2e-3;
  if (std::abs(x - std::round(x)) < kWhole && std::abs(y - std::round(y)) < kWhole)
    file.world = {
        .axes = CameraWorld::Axes::grid, .crs = zone, .origin = {std::round(x), std::round(y), height}};
  else
    file.world = {.axes = CameraWorld::Axes::enu, .origin = {lon, lat, height}};
}

void add_reconstruction(const JsonValue& part, CameraFile& file) {
  for (const std::string& name : part["shots"].keys()) {
    const JsonValue shot = part["shots"][name];
    CameraRecord record;
    record.image = name;
    record.location = "at " + shot.location();
    record.camera = camera_from_opensfm(part["cameras"][shot["camera"].text()]);
    record.world_from_camera = world_from_shot(shot);
    if (file.world.axes == CameraWorld::Axes::grid) record.world_from_camera->pretranslate(file.world.origin);
    file.images.push_back(std::move(record));
  }
}

CameraFile read_opensfm(const CameraSource& source) {
  const JsonValue root = JsonValue::from_file(source.path, {"points", "vertices", "faces"});
  if (!root.is_array() || root.size() == 0)
    root.refuse("this must be an array of reconstructions, at least one");
  const JsonValue first = root[0];
  CameraFile file;
  if (first.has("reference_lla")) set_world(first["reference_lla"], file);
  add_reconstruction(first, file);
  if (root.size() > 1)
    file.warnings.push_back(fmt::format("{}: {} separate reconstructions; the first, with {} images, is used",
                                        source.path, root.size(), file.images.size()));
  return file;
}

}  // namespace

void register_camera_format_opensfm(CameraFormats& formats);
void register_camera_format_opensfm(CameraFormats& formats) {
  formats.add({.name = "opensfm",
               .summary = "OpenSfM, OpenDroneMap: reconstruction.json",
               .recognises =
                   [](const CameraSource& s) {
                     const std::size_t start = s.head.find_first_not_of(" \t\r\n");
                     return start != s.head.npos && s.head[start] == '[' &&
                            (s.head.find("\"cameras\"") != s.head.npos ||
                             s.head.find("\"shots\"") != s.head.npos ||
                             s.head.find("\"projection_type\"") != s.head.npos);
                   },
               .read = read_opensfm});
}

}  // namespace waymark::importers

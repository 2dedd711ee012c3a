// SPDX-License-Identifier: Apache-2.0
// OpenDroneMap: shots.geojson with cameras.json beside it (or named by `interior`).
//  - translation is the position of the camera in a UTM zone, not the t of OpenSfM. The zone is not named;
//    it follows from the longitude and latitude of the point.
//  - rotation is an angle-axis vector, world to camera, world axes those of the grid.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "core/solve.hpp"
#include "geo/crs.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/interior_orientation.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

// Returns the zone if the positions agree with it within a metre; else camera_crs or the map's CRS applies.
std::string crs_of(const JsonValue& feature) {
  const JsonValue point = feature["geometry"]["coordinates"];
  const double lon = point[0].number(), lat = point[1].number();
  const Eigen::Vector3d place = feature["properties"]["translation"].vector3();
  const std::string crs = utm_zone(lon, lat);
  const auto [x, y] = CrsTransform(Crs::from_text("EPSG:4326"), Crs::from_text(crs))(lon, lat);
  return std::hypot(x - place.x(), y - place.y()) < 1 ? crs : "";
}

std::map<std::string, Camera> lenses_of(const CameraSource& source) {
  const std::string beside = (std::filesystem::path(source.path).parent_path() / "cameras.json").string();
  const std::string path = source.interior.empty() ? beside : source.interior;
  std::error_code ignored;
  if (source.interior.empty() && !std::filesystem::exists(beside, ignored)) return {};
  return read_interior(path);
}

// Makes a camera without cameras.json: the shot has focal length and size, but no distortion.
Camera plain_lens(const JsonValue& shot) {
  Camera camera;
  camera.columns = shot["width"].integer();
  camera.rows = shot["height"].integer();
  const auto width = static_cast<double>(camera.columns), height = static_cast<double>(camera.rows);
  camera.fx = camera.fy = shot["focal"].number() * std::fmax(width, height);
  camera.cx = width / 2 - 0.5;
  camera.cy = height / 2 - 0.5;
  return camera;
}

Eigen::Isometry3d world_from_camera(const JsonValue& shot) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_by(shot["rotation"].vector3()).transpose();
  pose.translation() = shot["translation"].vector3();
  return pose;
}

CameraFile read_odm_shots(const CameraSource& source) {
  const JsonValue root = JsonValue::from_file(source.path);
  const JsonValue features = root["features"];
  const auto lenses = lenses_of(source);
  CameraFile file;
  file.world.axes = CameraWorld::Axes::grid;
  if (features.size() > 0) file.world.crs = crs_of(features[0]);
  if (lenses.empty())
    file.warnings.push_back(fmt::format(
        "{}: there is no cameras.json beside it: the lens distortion is unknown and taken as none",
        source.path));
  for (std::size_t i = 0; i < features.size(); ++i) {
    const JsonValue shot = features[i]["properties"];
    CameraRecord record;
    record.image = shot["filename"].text();
    record.location = "at " + shot.location();
    record.camera =
        lenses.empty() ? plain_lens(shot) : interior_named(lenses, shot["camera"].text(), source.path);
    record.world_from_camera = world_from_camera(shot);
    file.images.push_back(std::move(record));
  }
  return file;
}

}  // namespace

void register_camera_format_odm_shots(CameraFormats& formats);
void register_camera_format_odm_shots(CameraFormats& formats) {
  formats.add({.name = "odm_shots",
               .summary = "OpenDroneMap: shots.geojson with cameras.json",
               .recognises =
                   [](const CameraSource& s) {
                     return s.head.find("FeatureCollection") != s.head.npos &&
                            s.head.find("\"capture_time\"") != s.head.npos;
                   },
               .read = read_odm_shots});
}

}  // namespace waymark::importers

// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/place_cameras.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "importers/cameras/control_points.hpp"
#include "importers/cameras/scale_camera.hpp"
#include "importers/cameras/world_to_grid.hpp"
#include "importers/images/image.hpp"
#include "importers/images/sun_position.hpp"

namespace waymark::importers {
namespace {

using Covariance = Eigen::Matrix<double, 6, 6>;
using Axes = CameraWorld::Axes;

constexpr const char* kGeocentric = "EPSG:4978";
constexpr double kMaxStretch = 2e-3;  // of a metre per metre, between axes

Crs map_crs(const CameraFile& file, const std::string& path, const CameraImport& import) {
  std::string text = import.crs;
  if (text.empty() && file.world.axes == Axes::grid)
    text = file.world.crs.empty() ? import.camera_crs : file.world.crs;
  if (text.empty()) {
    std::string hint = "name the CRS of the DEM in the option crs, or local for metres on no body";
    if (file.world.axes == Axes::enu)
      hint += fmt::format(
          "; where there is no DEM: {}",
          local_projection(Crs::from_text("EPSG:4326"), file.world.origin.x(), file.world.origin.y()));
    throw Error(ErrorCode::input, "the camera file does not name the CRS of the map", path, hint);
  }
  const Crs map = Crs::from_text(text);
  if (map.kind() == CrsKind::geographic)
    throw Error(ErrorCode::input, fmt::format("cameras need a projected CRS, not degrees ({})", map.id()),
                path, "name a projected CRS in the option crs, that of the DEM");
  return map;
}

/// Covariance of a pose in the grid. A block that the file leaves out, or states as 0, is unknown: it is that
/// of the import.
Covariance covariance_of(const CameraRecord& record, const CameraImport& import, const Eigen::Matrix3d& turn,
                         double scale) {
  Covariance made = Covariance::Zero();
  if (record.covariance) {
    Covariance change = Covariance::Identity();
    change.bottomRightCorner<3, 3>() = scale * turn;
    made = change * *record.covariance * change.transpose();
  }
  const double rotation_sd = to_radians(import.rotation_sd).value, position_sd = import.position_sd.value;
  if (made.diagonal().head<3>().isZero(0)) made.diagonal().head<3>().setConstant(rotation_sd * rotation_sd);
  if (made.diagonal().tail<3>().isZero(0)) made.diagonal().tail<3>().setConstant(position_sd * position_sd);
  return made;
}

// Transforms one record at a time; warnings that apply to many are given once.
class Placer {
 public:
  Placer(const CameraFile& file, const std::string& path, const CameraImport& import, CameraSet& set)
      : path_(path), import_(import), set_(set) {
    if (file.world.axes == Axes::arbitrary)
      similarity_ = find_similarity(file);
    else
      to_grid_ = world_to_grid(file.world, import.camera_crs, set.crs, import.height_offset.value, path);
  }

  void place(const CameraRecord& record) {
    ImageCamera image;
    image.image = record.image;
    image.taken_utc = record.taken_utc;
    image.sun = record.sun;
    image.image_sun_angle = record.image_sun_angle;
    if (record.camera) check_camera(*record.camera, path_, record.location, set_.warnings);
    if (record.camera && record.world_from_camera) {
      const Eigen::Isometry3d& pose = *record.world_from_camera;
      const LocalRotation turn = similarity_ ? LocalRotation{similarity_->rotation, 1}
                                             : local_rotation_at(to_grid_, pose.translation());
      PosedCamera view;
      view.camera = *record.camera;
      view.grid_from_camera.transform.translation() = at(pose.translation());
      view.grid_from_camera.transform.linear() = turn.rotation * pose.linear();
      const double scale = similarity_ ? similarity_->scale : 1;
      view.covariance = covariance_of(record, import_, turn.rotation, scale);
      if (const auto& motion = record.motion)
        view.motion = {.shift = scale * turn.rotation * motion->shift, .turn = motion->turn};
      check_place(view, record, turn.stretch);
      image.view = view;
      if (record.towards_sun && !image.sun)
        image.sun = sun_of(turn.rotation * *record.towards_sun, record.image);
    }
    if (ImageCamera* known = find(image.image)) {
      set_.warnings.push_back(
          fmt::format("{}: two images are named '{}': neither pose is used", path_, image.image));
      known->view.reset();
      return;
    }
    places_[image.image] = set_.images.size();
    set_.images.push_back(std::move(image));
  }

 private:
  ImageCamera* find(const std::string& name) {
    const auto known = places_.find(name);
    return known == places_.end() ? nullptr : &set_.images[known->second];
  }

  Eigen::Vector3d at(const Eigen::Vector3d& place) const {
    return similarity_ ? *similarity_ * place : to_grid_(place);
  }

  Similarity find_similarity(const CameraFile& file) {
    if (import_.map_from_frame) return *import_.map_from_frame;
    if (import_.control_points.empty())
      world_to_grid(file.world, {}, set_.crs, 0, path_);  // throws with the remedy
    const Georeferencing found = read_control_points(import_.control_points, file);
    set_.warnings.push_back(found.report);
    return found.map_from_frame;
  }

  void check_place(const PosedCamera& view, const CameraRecord& record, double stretch) {
    if (!view.grid_from_camera.transform.matrix().allFinite())
      throw Error(
          ErrorCode::input,
          fmt::format("the position of '{}' is outside the domain of {}", record.image, set_.crs.id()),
          path_ + ", " + record.location, "check the CRS of the map and of the cameras");
    if (stretch_reported_ || !(stretch - 1 > kMaxStretch)) return;
    stretch_reported_ = true;
    set_.warnings.push_back(fmt::format(
        "{} distorts shapes by {:.2g} % at the cameras, and ray intersections by the same fraction of the "
        "distance to the nadir: warp the DEM to a conformal projection, e.g. {}",
        set_.crs.id(), 100 * (stretch - 1), projection_here(view)));
  }

  std::string projection_here(const PosedCamera& view) const {
    const double unit = set_.crs.metres_per_unit();
    const CrsTransform to_degrees(set_.crs, geographic_crs(set_.crs));
    const auto [lon, lat] = to_degrees(view.centre().xyz.x() / unit, view.centre().xyz.y() / unit);
    return local_projection(set_.crs, lon, lat);
  }

  std::optional<Sun> sun_of(const Eigen::Vector3d& towards_sun, const std::string& image) {
    const Sun sun = sun_from_direction(towards_sun);
    if (sun.elevation.value > 0) return sun;
    set_.warnings.push_back(fmt::format("{}: the sun is at {:.1f} deg, below the horizon, and is not used",
                                        image, sun.elevation.value));
    return std::nullopt;
  }

  const std::string& path_;
  const CameraImport& import_;
  CameraSet& set_;
  WorldToGrid to_grid_;
  std::optional<Similarity> similarity_;
  std::map<std::string, std::size_t> places_;
  bool stretch_reported_ = false;
};

}  // namespace

CameraSet place_cameras(const CameraFile& given, const std::string& path, const CameraImport& import) {
  if (given.images.empty())
    throw Error(ErrorCode::input, "the camera file names no images", path, "check that it is the right file");
  CameraFile file = given;
  if (file.world.axes == Axes::arbitrary && !import.camera_crs.empty()) {
    file.world.axes = import.camera_crs == kGeocentric ? Axes::earth : Axes::grid;
    file.world.crs = import.camera_crs == kGeocentric ? "" : import.camera_crs;
  }
  CameraSet set;
  set.crs = map_crs(file, path, import);
  set.warnings = file.warnings;
  if (file.world.axes != Axes::arbitrary && (!import.control_points.empty() || import.map_from_frame))
    set.warnings.push_back(
        fmt::format("{} {} not used: {} the frame of the poses",
                    import.map_from_frame ? "the similarity" : import.control_points,
                    import.map_from_frame ? "is" : "are",
                    given.world.axes == Axes::arbitrary ? "camera_crs states" : "the camera file states"));
  Placer placer(file, path, import, set);
  for (const CameraRecord& record : file.images) placer.place(record);
  return set;
}

}  // namespace waymark::importers

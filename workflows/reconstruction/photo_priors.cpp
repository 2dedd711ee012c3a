// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_priors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "geo/crs.hpp"
#include "importers/cameras/camera_file.hpp"
#include "workflows/reconstruction/photo_positions.hpp"

namespace waymark::workflows {
namespace {

constexpr double kPriorDegree = std::numbers::pi / 180;

// Angle from grid north to true north, clockwise, radians.
double convergence(const CrsTransform& to_grid, double lon, double lat) {
  const auto here = to_grid(lon, lat), north = to_grid(lon, lat + (lat > 89 ? -1e-4 : 1e-4));
  return std::atan2(north.x - here.x, north.y - here.y);
}

// Turn of the axes of the stored picture against those of the upright one, about the view, radians clockwise.
// Orientation 6 stores the top of the picture in column 0: its columns run down (EXIF 2.32, 4.6.4 A).
std::optional<double> stored_turn(int orientation) {
  switch (orientation) {
    case 1:
      return 0;
    case 3:
      return std::numbers::pi;
    case 6:
      return std::numbers::pi / 2;
    case 8:
      return -std::numbers::pi / 2;
    default:
      return std::nullopt;
  }
}

Eigen::Matrix3d attitude_of(const importers::GimbalAngles& gimbal, double grid_yaw, double turn) {
  Eigen::Matrix3d level;  // looks north: x east, y down, z north
  level << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return Eigen::AngleAxisd(-grid_yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level *
         Eigen::AngleAxisd(gimbal.pitch * kPriorDegree, Eigen::Vector3d::UnitX()).toRotationMatrix() *
         Eigen::AngleAxisd(gimbal.roll * kPriorDegree + turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Mean of the two middle values of an even number.
double middle_value(std::vector<double> values) {
  std::ranges::sort(values);
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

// Heights above take-off where all pictures have them, since they are more exact. One altitude or more
// then give the height of the take-off.
struct HeightSource {
  bool relative = true;
  double takeoff = 0;

  std::optional<double> of(const importers::PhotoMetadata& m) const {
    return relative ? std::optional(*m.height_above_takeoff + takeoff) : m.position->altitude;
  }
};

HeightSource height_source(const Photos& photos) {
  HeightSource out;
  std::vector<double> takeoffs;
  for (const Photo& photo : photos.photos) {
    const importers::PhotoMetadata& m = photo.metadata;
    if (!m.position) continue;
    out.relative = out.relative && m.height_above_takeoff.has_value();
    if (m.height_above_takeoff && m.position->altitude)
      takeoffs.push_back(*m.position->altitude - *m.height_above_takeoff);
  }
  if (!takeoffs.empty()) out.takeoff = middle_value(takeoffs);
  return out;
}

// Returns why the position of a picture cannot be right beside those of the others; empty if it can.
std::string refusal_of_position(const Photo& photo, const LonLat& middle) {
  const LonLat stated{photo.metadata.position->lon, photo.metadata.position->lat};
  const double degrees = degrees_apart(stated, middle);
  if (degrees < kLongestFlight) return {};
  return fmt::format("the GPS position of {} is not used: it is {:.0f} km from those of the other images; {}",
                     photo.name, degrees * 111, cause_of_distance(stated, middle));
}

Crs grid_crs(const std::string& text) {
  const Crs crs = Crs::from_text(text);
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, fmt::format("{} is in degrees; poses need metres", crs.id()), "--crs",
                "pass a projected CRS, e.g. --crs EPSG:32651");
  if (crs.kind() == CrsKind::local || crs.body().name != earth().name)
    throw Error(ErrorCode::usage,
                fmt::format("{} is not on Earth, but the images have GPS positions", crs.id()), "--crs",
                "pass a projected CRS of Earth, or leave it out");
  return crs;
}

// A gimbal knows the vertical, and a barometer heights, without any position.
void add_without_position(PhotoPriors& out, std::size_t image, const importers::PhotoMetadata& m,
                          const PriorAccuracy& accuracy) {
  if (m.height_above_takeoff)
    out.heights.push_back(
        {.image = image, .height = *m.height_above_takeoff, .sd = accuracy.height_above_takeoff});
  const auto turn = stored_turn(m.orientation);
  if (!m.gimbal || !turn) return;
  out.ups.push_back({.image = image,
                     .up_in_camera = attitude_of(*m.gimbal, 0, *turn).transpose() * Eigen::Vector3d::UnitZ(),
                     .sd = accuracy.tilt * kPriorDegree});
}

}  // namespace

PhotoPriors photo_priors(const Photos& photos, const std::string& crs, const PriorAccuracy& accuracy) {
  PhotoPriors out;
  std::optional<CrsTransform> to_grid;
  double unit = 1;
  const HeightSource heights = height_source(photos);
  const auto middle = middle_of_positions(photos);
  for (std::size_t i = 0; i < photos.photos.size(); ++i) {
    const importers::PhotoMetadata& m = photos.photos[i].metadata;
    if (!m.position) {
      add_without_position(out, i, m, accuracy);
      continue;
    }
    if (std::string refusal = refusal_of_position(photos.photos[i], *middle); !refusal.empty()) {
      out.warnings.push_back(std::move(refusal));
      continue;
    }
    if (!to_grid) {
      out.crs = crs.empty() ? importers::utm_zone(m.position->lon, m.position->lat) : crs;
      const Crs grid = grid_crs(out.crs);
      to_grid.emplace(geographic_crs(grid), grid);
      unit = grid.metres_per_unit();
    }
    const auto at = (*to_grid)(m.position->lon, m.position->lat);
    if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
    const std::optional<double> height = heights.of(m);
    const double height_sd = !height            ? std::numeric_limits<double>::infinity()
                             : heights.relative ? accuracy.height_above_takeoff
                                                : accuracy.altitude;
    out.positions.push_back({.image = i,
                             .position = {at.x * unit, at.y * unit, height.value_or(0)},
                             .sd = {accuracy.horizontal, accuracy.horizontal, height_sd},
                             .biased_height = true});
    const auto turn = stored_turn(m.orientation);
    if (!m.gimbal || !turn) continue;
    const double yaw = m.gimbal->yaw * kPriorDegree + convergence(*to_grid, m.position->lon, m.position->lat);
    const bool steep = std::abs(m.gimbal->pitch) > 45;
    out.attitudes.push_back(
        {.image = i,
         .world_from_camera = Eigen::Quaterniond(attitude_of(*m.gimbal, yaw, *turn)),
         .sd = kPriorDegree * (steep ? Eigen::Vector3d(accuracy.tilt, accuracy.tilt, accuracy.yaw)
                                     : Eigen::Vector3d(accuracy.tilt, accuracy.yaw, accuracy.tilt))});
  }
  return out;
}

}  // namespace waymark::workflows

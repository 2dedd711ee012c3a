// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>

#include "localization/global/skyline.hpp"
#include "localization/global/skyline_view.hpp"

namespace waymark::localization {

SummitView view_summit(const SkylineSummit& summit, const Eigen::Vector2d& eye, double eye_height,
                       const SkylineOptions& options) {
  const Eigen::Vector2d d = summit.at - eye;
  const double distance = std::max(d.norm(), 1.0);
  const double rise =
      summit.height - eye_height - curvature_drop(distance, options.body_radius, options.refraction);
  return {std::atan2(d.y(), d.x()), std::atan2(rise, distance), distance};
}

bool clears_terrain(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const TerrainHeight& ground,
                    const SkylineOptions& options, double step, double margin) {
  const Eigen::Vector2d d = (to - from).head<2>();
  const double distance = d.norm();
  const double drop = curvature_drop(distance, options.body_radius, options.refraction);
  const double slope = (to.z() - drop - from.z()) / std::max(distance, 1.0);
  for (double t = step; t < distance - margin; t += step) {
    const auto height = ground(from.head<2>() + d * (t / distance));
    if (!height) continue;  // unknown terrain does not occlude
    if (*height - curvature_drop(t, options.body_radius, options.refraction) > from.z() + slope * t)
      return false;
  }
  return true;
}

std::optional<PoseEstimate> resection(std::span<const HorizonTop> tops,
                                      std::span<const SkylineSummit> summits,
                                      std::span<const std::optional<std::uint32_t>> matches,
                                      const PoseEstimate& start, const TerrainHeight& ground,
                                      const SkylineOptions& options) {
  constexpr double kSlope = 30;  // m, baseline of the terrain's slope
  PoseEstimate e = start;
  for (int step = 0; step < 8; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d information_vector = Eigen::Vector3d::Zero();
    int rows = 0;
    const auto add = [&](const Eigen::Vector3d& by_pose, double v, double variance) {
      information += by_pose * by_pose.transpose() / variance;
      information_vector += by_pose * v / variance;
      ++rows;
    };
    const Eigen::Vector2d at = e.pose.at();
    const auto height = ground(at), east = ground(at + Eigen::Vector2d(kSlope, 0)),
               north = ground(at + Eigen::Vector2d(0, kSlope));
    if (!height) return {};
    const double eye = *height + options.eye;
    for (std::size_t i = 0; i < tops.size(); ++i) {
      if (!matches[i]) continue;
      const SkylineSummit& summit = summits[*matches[i]];
      const SummitView view = view_summit(summit, at, eye, options);
      const Eigen::Vector2d along = (summit.at - at) / view.distance;
      const double r = view.distance, place = options.position_sd / r, tall = options.height_sd / r;
      add({along.y() / r, -along.x() / r, -1}, wrap_angle(tops[i].bearing - (view.azimuth - e.pose.yaw)),
          tops[i].bearing_sd * tops[i].bearing_sd + place * place);
      if (!tops[i].elevation) continue;
      const double rise = std::tan(view.elevation);
      const double flat = 1 / (1 + rise * rise);
      const Eigen::Vector2d slope(east ? (*east - *height) / kSlope : 0,
                                  north ? (*north - *height) / kSlope : 0);
      const Eigen::Vector2d by_position = flat / r * (rise * along - slope);
      add({by_position.x(), by_position.y(), 0}, *tops[i].elevation - view.elevation,
          tops[i].elevation_sd * tops[i].elevation_sd + tall * tall);
    }
    if (options.heading)
      add({0, 0, 1}, wrap_angle(*options.heading - e.pose.yaw), options.heading_sd * options.heading_sd);
    if (rows < 3) return {};
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    if (!solver.isPositive() || !(solver.rcond() > 1e-14)) return {};
    Eigen::Vector3d change = solver.solve(information_vector);
    if (!change.allFinite()) return {};
    const double far = change.head<2>().norm();
    if (far > 2000) change *= 2000 / far;
    e = {pose_of(e.pose.vector() + change), solver.solve(Eigen::Matrix3d::Identity())};
    if (far < 0.5) break;
  }
  return e;
}

}  // namespace waymark::localization

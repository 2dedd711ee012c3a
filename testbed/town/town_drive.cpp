// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town_drive.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/random.hpp"
#include "testbed/drive/drive.hpp"
#include "testbed/drive/drive_readings.hpp"
#include "testbed/drive/ranges_text.hpp"
#include "testbed/town/town_scanner.hpp"

namespace waymark::testbed {
namespace {

constexpr double kMargin = 10;  // m of level ground around the path

Terrain level_ground(const std::vector<Eigen::Vector2d>& path) {
  Eigen::Vector2d low = path[0], high = path[0];
  for (const Eigen::Vector2d& p : path) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Eigen::Vector2d size = high - low + Eigen::Vector2d::Constant(2 * kMargin);
  return {Grid<float>(2, 2, 0.0F), low.x() - kMargin, high.y() + kMargin, size.x(), size.y()};
}

/// Returns the strengths of the returns of a sweep: that of the strongest surface at the range within the
/// beam.
std::string intensities_text(const Town& town, const DriveStep& step, const localization::LaserScan& scan,
                             std::uint64_t seed) {
  Random random(seed, "intensities");
  constexpr double kSameRange = 0.25;  // m
  const double width = scan.angle_step;
  std::string text;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    float strongest = 0;
    const double range = static_cast<double>(scan.ranges[i]);
    for (const double off : {-0.4, 0.0, 0.4}) {
      const double angle = step.at.plane.yaw + scan.first_angle + (static_cast<double>(i) + off) * width;
      const auto hit = town.hit(step.at.plane.at(), {std::cos(angle), std::sin(angle)}, step.t);
      if (hit && range > 0 && std::abs(hit->range - range) < kSameRange)
        strongest = std::max(strongest, strength_of(*hit, random));
    }
    text += fmt::format("{}{:.3g}", i ? "," : "", strongest);
  }
  return text;
}

std::string scan_line(const Town& town, const DriveStep& step, const LaserModel& laser, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector2d from = step.at.plane.at();
  const RayCast cast = [&](const Eigen::Vector3d& along) {
    return town.cast(from, along.head<2>().normalized(), step.t);
  };
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(step.at.plane.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const localization::LaserScan scan = sweep(cast, turn, laser, random);
  const std::string line = fmt::format(
      "{{\"kind\":\"laser\",\"t\":{:.3f},\"first_angle\":{:.7f},\"angle_step\":{:.9f},\"most_range\":{:g},"
      "\"beam_width\":{:.6f},\"ranges\":[",
      step.t, scan.first_angle, scan.angle_step, scan.max_range,
      laser.perfect ? 0 : to_radians(laser.divergence).value * std::max(0.0, 1 - 2 * laser.sensitivity));
  const std::string ranges = line + ranges_text(scan.ranges, 3) + "]";
  const bool has_reflectors =
      std::ranges::any_of(town.posts, [](const TownPost& p) { return p.surface.retro; });
  return ranges +
         (has_reflectors ? ",\"intensities\":[" + intensities_text(town, step, scan, seed) + "]}\n" : "}\n");
}

/// Writes a turn of the 3-D scanner and returns its record.
std::string points_line(const Town& town, const DriveStep& step, const ScannerModel& scanner,
                        std::uint64_t seed, std::size_t index, const TownFileSink& sink) {
  Random random(seed);
  const std::string name = fmt::format("points/{:06}.bin", index);
  sink(name, kitti_bytes(turn_of_scanner(town, step.at.plane, step.t, scanner, random)));
  return fmt::format("{{\"kind\":\"points\",\"t\":{:.3f},\"file\":\"{}\"}}\n", step.t, name);
}

}  // namespace

DriveSettings town_settings() {
  DriveSettings settings;
  settings.speed = 1;
  settings.laser.every = 0.5;
  settings.laser.field = Degrees{270};
  settings.laser.step = Degrees{0.25};
  settings.laser.max_range = 30;
  settings.odometry.slip = 0.005;
  settings.odometry.slip_sd = 0.005;
  return settings;
}

TownDrive drive_through(const Town& town, const DriveSettings& settings, std::uint64_t seed,
                        const TownFileSink& sink) {
  const std::vector<DriveStep> steps =
      drive_along(level_ground(town.path), {}, town.path, settings, seed).steps;
  Random random(seed, "start");
  const localization::Pose2& start = steps.front().at.plane;
  TownDrive drive;
  drive.distance = steps.back().distance, drive.seconds = steps.back().t;
  const double x = start.x + random.normal(0, settings.start_sd),
               y = start.y + random.normal(0, settings.start_sd);
  const double yaw =
      localization::wrap_angle(start.yaw + random.normal(0, to_radians(settings.start_yaw_sd).value));
  drive.log = fmt::format(
      "{{\"kind\":\"header\",\"version\":1,\"frame\":\"crs\",\"crs\":\"local\",\"start\":{{\"x\":{:.4f},"
      "\"y\":{:.4f},"
      "\"yaw\":{:.5f},\"sd\":{:.4g},\"yaw_sd\":{:.4g}}},\"odometry_noise\":{},\"seed\":{}}}\n",
      x, y, yaw, std::max(settings.start_sd, 0.01), std::max(to_radians(settings.start_yaw_sd).value, 0.001),
      odometry_noise_json(settings, steps), seed);
  drive.track = "t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected\n";
  std::vector<std::string> lines(steps.size());
  std::vector<bool> scans(steps.size());
  double next = 0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (settings.laser.on && steps[i].t >= next - 1e-9) scans[i] = true, next += settings.laser.every;
  std::vector<std::optional<std::size_t>> turns(steps.size());
  next = 0;
  for (std::size_t i = 0, count = 0; i < steps.size(); ++i)
    if (sink && settings.scanner.on && steps[i].t >= next - 1e-9)
      turns[i] = count++, next += settings.scanner.every;
  tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t i) {
    const DriveStep& s = steps[i];
    lines[i] = fmt::format("{{\"kind\":\"odometry\",\"t\":{:.3f},\"v\":{:.5f},\"omega\":{:.6f}}}\n", s.t,
                           s.speed, s.turn);
    if (settings.truth_in_log)
      lines[i] +=
          fmt::format("{{\"kind\":\"truth\",\"t\":{:.3f},\"x\":{:.4f},\"y\":{:.4f},\"yaw\":{:.5f}}}\n", s.t,
                      s.at.plane.x, s.at.plane.y, s.at.plane.yaw);
    if (scans[i]) lines[i] += scan_line(town, s, settings.laser, named_seed(seed, "laser") + i);
    if (turns[i])
      lines[i] += points_line(town, s, settings.scanner, named_seed(seed, "scanner") + i, *turns[i], sink);
  });
  for (std::size_t i = 0; i < steps.size(); ++i) {
    drive.log += lines[i];
    const localization::Pose2& at = steps[i].at.plane;
    drive.track +=
        fmt::format("{:.3f},{:.4f},{:.4f},0,0,0,{:.5f},0,0,0,0,0,0\n", steps[i].t, at.x, at.y, at.yaw);
  }
  return drive;
}

}  // namespace waymark::testbed

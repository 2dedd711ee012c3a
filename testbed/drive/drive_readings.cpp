// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/options/option_table.hpp"
#include "testbed/drive/odometry_errors.hpp"
#include "testbed/drive/ranges_text.hpp"

namespace waymark::testbed {
namespace {

std::string noise_as_json(OdometryErrors errors) {
  std::string text;
  for (const OptionRow& row : option_table([&](OptionVisitor& option) {
         errors.noise.describe(option);
         errors.drift.describe(option);
       }))
    text += fmt::format("{}\"{}\":{:.4g}", text.empty() ? "{" : ",", row.name, std::get<double>(row.value));
  return text + "}";
}

}  // namespace

std::string odometry_noise_json(const DriveSettings& settings, std::span<const DriveStep> steps) {
  return noise_as_json(odometry_errors(settings, steps));
}

std::string log_header(const DriveWorld& world, const LogCrs& place, const localization::Pose2& start,
                       std::span<const DriveStep> steps) {
  Random random(world.seed, "start");
  const DriveSettings& s = world.settings;
  const double x = start.x + random.normal(0, s.start_sd), y = start.y + random.normal(0, s.start_sd);
  const double yaw = localization::wrap_angle(start.yaw + random.normal(0, to_radians(s.start_yaw_sd).value));
  const bool local = place.crs == "local";
  return fmt::format(
      "{{\"kind\":\"header\",\"version\":1,\"frame\":\"{}\"{},\"start\":{{\"x\":{:.4f},\"y\":{:.4f},"
      "\"yaw\":"
      "{:.5f},\"sd\":{:.4g},\"yaw_sd\":{:.4g}}},\"odometry_noise\":{},\"vehicle\":\"{}\",\"seed\":{}}}\n",
      local ? "map" : "crs", local ? "" : fmt::format(",\"crs\":\"{}\"", place.crs),
      x / place.metres_per_unit, y / place.metres_per_unit, yaw, std::max(s.start_sd, 0.01),
      std::max(to_radians(s.start_yaw_sd).value, 0.001), odometry_noise_json(s, steps), s.vehicle,
      world.seed);
}

std::string odometry_lines(const DriveWorld& world, const LogCrs& place, const DriveStep& step) {
  std::string lines = fmt::format("{{\"kind\":\"odometry\",\"t\":{:.3f},\"v\":{:.5f},\"omega\":{:.6f}}}\n",
                                  step.t, step.speed, step.turn);
  if (!world.settings.truth_in_log) return lines;
  const localization::TerrainPose& at = step.at;
  return lines + fmt::format(
                     "{{\"kind\":\"truth\",\"t\":{:.3f},\"x\":{:.4f},\"y\":{:.4f},"
                     "\"yaw\":{:.5f},\"z\":{:.4f},\"roll\":{:.5f},\"pitch\":{:.5f}}}\n",
                     step.t, at.plane.x / place.metres_per_unit, at.plane.y / place.metres_per_unit,
                     at.plane.yaw, at.z, at.roll, at.pitch);
}

std::vector<localization::Pose2> laser_mounts(const DriveSettings& settings) {
  if (settings.harvester()) return {{0.5, 1.3, std::numbers::pi / 2}, {0.5, -1.3, -std::numbers::pi / 2}};
  return {{0.6, 0, 0}};
}

std::string laser_line(const DriveWorld& world, std::size_t i, const DriveStep& step, std::size_t which) {
  const localization::Pose2 mount = laser_mounts(world.settings)[which];
  const LaserModel& model = world.settings.laser;
  Random random(named_seed(world.seed, which == 0 ? "laser" : "laser 2") + i);
  const Eigen::Isometry3d grid_from_robot = step.at.grid_from_robot().transform;
  const Eigen::Vector3d origin =
      grid_from_robot * Eigen::Vector3d(mount.x, mount.y, world.settings.laser_height);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(mount.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d body =
      model.levelled ? Eigen::AngleAxisd(step.at.plane.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix()
                     : Eigen::Matrix3d(grid_from_robot.linear());
  const RayFan fan(world.targets, origin, model.max_range, step.t);
  const localization::LaserScan scan = sweep(fan, body * turn, model, random);
  const double tilt = model.perfect ? 0 : to_radians(model.tilt_sd).value;
  const double roll = model.levelled ? 0 : step.at.roll + random.normal(0, tilt);
  const double pitch = model.levelled ? 0 : step.at.pitch + random.normal(0, tilt);
  const std::string line = fmt::format(
      "{{\"kind\":\"laser\",\"t\":{:.3f},\"mount\":{{\"x\":{:.3f},\"y\":{:.3f},\"yaw\":{:.6f}}},\"roll\":{:"
      ".5f},"
      "\"pitch\":{:.5f},\"first_angle\":{:.7f},\"angle_step\":{:.9f},\"most_range\":{:g},\"beam_width\":{:."
      "6f},"
      "\"ranges\":[",
      step.t, mount.x, mount.y, mount.yaw, roll, pitch, scan.first_angle, scan.angle_step, scan.max_range,
      model.perfect ? 0 : to_radians(model.divergence).value * std::max(0.0, 1 - 2 * model.sensitivity));
  return line + ranges_text(scan.ranges, 3) + "]}\n";
}

std::string depth_line(const DriveWorld& world, std::size_t i, const DriveStep& step) {
  const StereoModel& model = world.settings.stereo;
  Random random(named_seed(world.seed, "stereo") + i);
  const Eigen::Isometry3d body = step.at.grid_from_robot().transform;
  const RayFan fan(world.targets, body * Eigen::Vector3d(0.5, 0, model.height), model.max_range, step.t);
  const localization::DepthImage image = depth_image(fan, body.linear(), model, random);
  const std::string line = fmt::format(
      "{{\"kind\":\"depth\",\"t\":{:.3f},\"mount\":{{\"x\":0.5,\"y\":0}},\"height\":{:g},\"tilt\":{:.6f},"
      "\"roll\":{:.5f},\"pitch\":{:.5f},\"columns\":{},\"rows\":{},\"focal\":{:.4f},\"depths\":[",
      step.t, image.height, image.tilt, step.at.roll, step.at.pitch, image.columns, image.rows, image.focal);
  return line + ranges_text(image.depths, 2) + "]}\n";
}

std::string camera_line(const DriveWorld& world, std::size_t i, const DriveStep& step) {
  const BearingModel& model = world.settings.camera;
  Random random(named_seed(world.seed, "camera") + i);
  const Eigen::Isometry3d body = step.at.grid_from_robot().transform;
  const RayFan fan(world.targets, body * Eigen::Vector3d(0, 0, model.height), model.max_range, step.t);
  const double sd = std::max(1e-4, to_radians(model.bearing_sd).value);
  std::string line = fmt::format("{{\"kind\":\"sightings\",\"t\":{:.3f},\"items\":[", step.t);
  bool first = true;
  for (const BearingDetection& seen :
       bearings(world.targets, fan, step.at.plane.yaw, model, step.t, random)) {
    line += fmt::format("{}{{\"bearing\":{:.5f},\"bearing_sd\":{:.5f},\"type\":\"{}\"}}", first ? "" : ",",
                        seen.bearing, sd, seen.kind == TargetKind::stem ? "tree" : "rock");
    first = false;
  }
  return line + "]}\n";
}

std::string panorama_line(const DriveWorld& world, std::size_t i, const DriveStep& step) {
  const PanoramaModel& model = world.settings.panorama;
  Random random(named_seed(world.seed, "panorama") + i);
  const Eigen::Vector3d eye(step.at.plane.x, step.at.plane.y, step.at.z + model.height);
  std::string line = fmt::format(
      "{{\"kind\":\"panorama\",\"t\":{:.3f},\"height\":{:g},\"first_angle\":{:.7f},\"angle_step\":{:.9f},"
      "\"elevation_sd\":{:.6f},\"elevations\":[",
      step.t, model.height, -std::numbers::pi, to_radians(model.step).value,
      std::max(1e-5, to_radians(model.elevation_sd).value));
  bool first = true;
  for (const double e : horizon(world.targets.terrain(), eye, step.at.plane.yaw, model, random)) {
    line += first ? "" : ",";
    line += std::isfinite(e) ? fmt::format("{:.5f}", e) : "null";
    first = false;
  }
  return line + "]}\n";
}

GnssReceiver::GnssReceiver(const GnssModel& model, std::uint64_t seed)
    : model_(model),
      random_(seed, "gnss"),
      bias_(Eigen::Vector2d(random_.normal(0, model.bias_sd), random_.normal(0, model.bias_sd))) {}

std::string GnssReceiver::line(const DriveStep& step, const LogCrs& place) {
  const GnssModel& g = model_;
  const double fade = std::exp(-g.every / g.bias_time);
  const Eigen::Vector2d noise(random_.normal(0, g.sd), random_.normal(0, g.sd));
  const bool missed = random_.bernoulli(g.dropouts);
  const Eigen::Vector2d at = step.at.plane.at() + (g.perfect ? Eigen::Vector2d(0, 0) : noise + bias_);
  bias_ = fade * bias_ + std::sqrt(1 - fade * fade) *
                             Eigen::Vector2d(random_.normal(0, g.bias_sd), random_.normal(0, g.bias_sd));
  if (missed && !g.perfect) return {};
  const double sd = g.perfect ? 0.01 : std::hypot(g.sd, g.bias_sd);
  return fmt::format("{{\"kind\":\"gnss\",\"t\":{:.3f},\"x\":{:.3f},\"y\":{:.3f},\"sd\":{:.3f}}}\n", step.t,
                     at.x() / place.metres_per_unit, at.y() / place.metres_per_unit, sd);
}

DriveSensors::DriveSensors(const DriveWorld& world, LogCrs place)
    : world_(world), place_(std::move(place)), receiver_(world.settings.gnss, world.seed) {
  const DriveSettings& s = world.settings;
  if (s.laser.on)
    for (std::size_t m = 0; m < laser_mounts(s).size(); ++m)
      sensors_.push_back({s.laser.every, [this, m](std::size_t i, const DriveStep& step) {
                            return laser_line(world_, i, step, m);
                          }});
  const auto add = [&](bool on, double every, auto line) {
    if (on)
      sensors_.push_back(
          {every, [this, line](std::size_t i, const DriveStep& step) { return line(world_, i, step); }});
  };
  add(s.stereo.on, s.stereo.every, depth_line);
  add(s.camera.on, s.camera.every, camera_line);
  add(s.panorama.on, s.panorama.every, panorama_line);
  if (s.gnss.on)
    sensors_.push_back(
        {s.gnss.every, [this](std::size_t, const DriveStep& step) { return receiver_.line(step, place_); }});
}

std::vector<std::string> DriveSensors::lines(std::size_t i, const DriveStep& step) {
  std::vector<std::string> lines;
  for (Sensor& sensor : sensors_) {
    if (!(step.t >= sensor.next - 1e-9)) continue;
    sensor.next += sensor.every;
    if (std::string line = sensor.line(i, step); !line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace waymark::testbed

// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_log.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "core/random.hpp"

namespace waymark::testbed {
namespace {

// Reading to be simulated; readings of equal time keep the order in which they were added.
struct Reading {
  double t = 0;
  std::function<std::string()> line;
};

class LogMaker {
 public:
  LogMaker(const DriveWorld& world, const LogCrs& place) : world_(world), place_(place) {}

  std::string log() {
    odometry();
    if (world_.settings.laser.on) lasers();
    if (world_.settings.stereo.on)
      at_times(world_.settings.stereo.every, [&](std::size_t i) { add(i, [this, i] { return depth(i); }); });
    if (world_.settings.camera.on)
      at_times(world_.settings.camera.every, [&](std::size_t i) { add(i, [this, i] { return camera(i); }); });
    if (world_.settings.panorama.on)
      at_times(world_.settings.panorama.every,
               [&](std::size_t i) { add(i, [this, i] { return panorama(i); }); });
    if (world_.settings.gnss.on) gnss();
    crane();
    std::ranges::stable_sort(readings_, {}, &Reading::t);
    std::vector<std::string> lines(readings_.size());
    tbb::parallel_for(std::size_t{0}, readings_.size(),
                      [&](std::size_t i) { lines[i] = readings_[i].line(); });
    std::string text = header();
    for (const std::string& line : lines) text += line;
    return text;
  }

 private:
  std::string header() const {
    Random random(world_.seed, "start");
    const DriveSettings& s = world_.settings;
    const localization::Pose2& start = world_.steps.front().at.plane;
    const double x = start.x + random.normal(0, s.start_sd), y = start.y + random.normal(0, s.start_sd);
    const double yaw =
        localization::wrap_angle(start.yaw + random.normal(0, to_radians(s.start_yaw_sd).value));
    const bool local = place_.crs == "local";
    return fmt::format(
        "{{\"kind\":\"header\",\"version\":1,\"frame\":\"{}\"{},\"start\":{{\"x\":{:.4f},\"y\":{:.4f},"
        "\"yaw\":"
        "{:.5f},\"sd\":{:.4g},\"yaw_sd\":{:.4g}}},\"vehicle\":\"{}\",\"seed\":{}}}\n",
        local ? "map" : "crs", local ? "" : fmt::format(",\"crs\":\"{}\"", place_.crs),
        x / place_.metres_per_unit, y / place_.metres_per_unit, yaw, std::max(s.start_sd, 0.01),
        std::max(to_radians(s.start_yaw_sd).value, 0.001), s.vehicle, world_.seed);
  }

  void odometry() {
    for (const DriveStep& step : world_.steps)
      readings_.push_back(
          {step.t, [&step, this] {
             std::string lines =
                 fmt::format("{{\"kind\":\"odometry\",\"t\":{:.3f},\"v\":{:.5f},\"omega\":{:.6f}}}\n", step.t,
                             step.speed, step.turn);
             if (!world_.settings.truth_in_log) return lines;
             const localization::TerrainPose& at = step.at;
             return lines + fmt::format(
                                "{{\"kind\":\"truth\",\"t\":{:.3f},\"x\":{:.4f},\"y\":{:.4f},"
                                "\"yaw\":{:.5f},\"z\":{:.4f},\"roll\":{:.5f},\"pitch\":{:.5f}}}\n",
                                step.t, at.plane.x / place_.metres_per_unit,
                                at.plane.y / place_.metres_per_unit, at.plane.yaw, at.z, at.roll, at.pitch);
           }});
  }

  // Calls `visit` with the steps at which a sensor of this period measures.
  template <class Visit>
  void at_times(double every, Visit&& visit) {
    double next = 0;
    for (std::size_t i = 0; i < world_.steps.size(); ++i)
      if (world_.steps[i].t >= next - 1e-9) {
        visit(i);
        next += every;
      }
  }

  void lasers() {
    struct Mount {
      double x, y, yaw;
    };
    const std::vector<Mount> mounts =
        world_.settings.harvester()
            ? std::vector<Mount>{{0.5, 1.3, std::numbers::pi / 2}, {0.5, -1.3, -std::numbers::pi / 2}}
            : std::vector<Mount>{{0.6, 0, 0}};
    for (std::size_t m = 0; m < mounts.size(); ++m)
      at_times(world_.settings.laser.every, [&](std::size_t i) {
        const Mount mount = mounts[m];
        readings_.push_back({world_.steps[i].t, [this, i, m, mount] {
                               return laser(i, m, localization::Pose2{mount.x, mount.y, mount.yaw});
                             }});
      });
  }

  std::string laser(std::size_t i, std::size_t which, const localization::Pose2& mount) const {
    const DriveStep& step = world_.steps[i];
    const LaserModel& model = world_.settings.laser;
    Random random(named_seed(world_.seed, which == 0 ? "laser" : "laser 2") + i);
    const Eigen::Isometry3d grid_from_robot = step.at.grid_from_robot().transform;
    const Eigen::Vector3d origin =
        grid_from_robot * Eigen::Vector3d(mount.x, mount.y, world_.settings.laser_height);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(mount.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Matrix3d body =
        model.levelled ? Eigen::AngleAxisd(step.at.plane.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix()
                       : Eigen::Matrix3d(grid_from_robot.linear());
    const RayFan fan(world_.targets, origin, model.max_range, step.t);
    const localization::LaserScan scan = sweep(fan, body * turn, model, random);
    const double tilt = model.perfect ? 0 : to_radians(model.tilt_sd).value;
    const double roll = model.levelled ? 0 : step.at.roll + random.normal(0, tilt);
    const double pitch = model.levelled ? 0 : step.at.pitch + random.normal(0, tilt);
    std::string line = fmt::format(
        "{{\"kind\":\"laser\",\"t\":{:.3f},\"mount\":{{\"x\":{:.3f},\"y\":{:.3f},\"yaw\":{:.6f}}},\"roll\":{:"
        ".5f},"
        "\"pitch\":{:.5f},\"first_angle\":{:.7f},\"angle_step\":{:.9f},\"most_range\":{:g},\"beam_width\":{:."
        "6f},"
        "\"ranges\":[",
        step.t, mount.x, mount.y, mount.yaw, roll, pitch, scan.first_angle, scan.angle_step, scan.max_range,
        model.perfect ? 0 : to_radians(model.divergence).value * std::max(0.0, 1 - 2 * model.sensitivity));
    for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
      if (k > 0) line += ',';
      if (scan.ranges[k] > 0)
        fmt::format_to(std::back_inserter(line), "{:.3f}", scan.ranges[k]);
      else
        line += "null";
    }
    return line + "]}\n";
  }

  void add(std::size_t step, std::function<std::string()> line) {
    readings_.push_back({world_.steps[step].t, std::move(line)});
  }

  std::string depth(std::size_t i) const {
    const DriveStep& step = world_.steps[i];
    const StereoModel& model = world_.settings.stereo;
    Random random(named_seed(world_.seed, "stereo") + i);
    const Eigen::Isometry3d body = step.at.grid_from_robot().transform;
    const RayFan fan(world_.targets, body * Eigen::Vector3d(0.5, 0, model.height), model.max_range, step.t);
    const localization::DepthImage image = depth_image(fan, body.linear(), model, random);
    std::string line = fmt::format(
        "{{\"kind\":\"depth\",\"t\":{:.3f},\"mount\":{{\"x\":0.5,\"y\":0}},\"height\":{:g},\"tilt\":{:.6f},"
        "\"roll\":{:.5f},\"pitch\":{:.5f},\"columns\":{},\"rows\":{},\"focal\":{:.4f},\"depths\":[",
        step.t, image.height, image.tilt, step.at.roll, step.at.pitch, image.columns, image.rows,
        image.focal);
    for (std::size_t k = 0; k < image.depths.size(); ++k) {
      if (k > 0) line += ',';
      if (image.depths[k] > 0)
        fmt::format_to(std::back_inserter(line), "{:.2f}", image.depths[k]);
      else
        line += "null";
    }
    return line + "]}\n";
  }

  std::string camera(std::size_t i) const {
    const DriveStep& step = world_.steps[i];
    const BearingModel& model = world_.settings.camera;
    Random random(named_seed(world_.seed, "camera") + i);
    const Eigen::Isometry3d body = step.at.grid_from_robot().transform;
    const RayFan fan(world_.targets, body * Eigen::Vector3d(0, 0, model.height), model.max_range, step.t);
    const double sd = std::max(1e-4, to_radians(model.bearing_sd).value);
    std::string line = fmt::format("{{\"kind\":\"sightings\",\"t\":{:.3f},\"items\":[", step.t);
    bool first = true;
    for (const BearingDetection& seen :
         bearings(world_.targets, fan, step.at.plane.yaw, model, step.t, random)) {
      line += fmt::format("{}{{\"bearing\":{:.5f},\"bearing_sd\":{:.5f},\"type\":\"{}\"}}", first ? "" : ",",
                          seen.bearing, sd, seen.kind == TargetKind::stem ? "tree" : "rock");
      first = false;
    }
    return line + "]}\n";
  }

  std::string panorama(std::size_t i) const {
    const DriveStep& step = world_.steps[i];
    const PanoramaModel& model = world_.settings.panorama;
    Random random(named_seed(world_.seed, "panorama") + i);
    const Eigen::Vector3d eye(step.at.plane.x, step.at.plane.y, step.at.z + model.height);
    std::string line = fmt::format(
        "{{\"kind\":\"panorama\",\"t\":{:.3f},\"height\":{:g},\"first_angle\":{:.7f},\"angle_step\":{:.9f},"
        "\"elevation_sd\":{:.6f},\"elevations\":[",
        step.t, model.height, -std::numbers::pi, to_radians(model.step).value,
        std::max(1e-5, to_radians(model.elevation_sd).value));
    bool first = true;
    for (const double e : horizon(world_.targets.terrain(), eye, step.at.plane.yaw, model, random)) {
      line += first ? "" : ",";
      line += std::isfinite(e) ? fmt::format("{:.5f}", e) : "null";
      first = false;
    }
    return line + "]}\n";
  }

  // The correlated error is an Ornstein-Uhlenbeck process; missing fixes advance it, too.
  void gnss() {
    const GnssModel& g = world_.settings.gnss;
    Random random(world_.seed, "gnss");
    Eigen::Vector2d bias(random.normal(0, g.bias_sd), random.normal(0, g.bias_sd));
    const double fade = std::exp(-g.every / g.bias_time);
    at_times(g.every, [&](std::size_t i) {
      const DriveStep& step = world_.steps[i];
      const Eigen::Vector2d noise(random.normal(0, g.sd), random.normal(0, g.sd));
      const bool missed = random.bernoulli(g.dropouts);
      const Eigen::Vector2d at = step.at.plane.at() + (g.perfect ? Eigen::Vector2d(0, 0) : noise + bias);
      bias = fade * bias + std::sqrt(1 - fade * fade) *
                               Eigen::Vector2d(random.normal(0, g.bias_sd), random.normal(0, g.bias_sd));
      if (missed && !g.perfect) return;
      const double sd = g.perfect ? 0.01 : std::hypot(g.sd, g.bias_sd);
      readings_.push_back(
          {step.t, [this, at, sd, t = step.t] {
             return fmt::format(
                 "{{\"kind\":\"gnss\",\"t\":{:.3f},\"x\":{:.3f},\"y\":{:.3f},\"sd\":{:.3f}}}\n", t,
                 at.x() / place_.metres_per_unit, at.y() / place_.metres_per_unit, sd);
           }});
    });
  }

  void crane() {
    const CraneModel& c = world_.settings.crane;
    for (const FelledTree& f : world_.felled) {
      const auto after = std::ranges::lower_bound(world_.steps, f.t - 1e-9, {}, &DriveStep::t);
      const localization::Pose2& at = after->at.plane;
      const StandingTree& tree = world_.trees[f.tree];
      Random random(named_seed(world_.seed, "crane") + f.tree);
      const Eigen::Vector2d to = tree.foot.head<2>() - at.at();
      const double range = std::max(0.1, to.norm() + random.normal(0, c.range_sd));
      const double bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - at.yaw +
                                                      random.normal(0, to_radians(c.bearing_sd).value));
      const double diameter = std::max(0.01, tree.dbh + random.normal(0, c.diameter_sd));
      const double height = std::max(1.3, tree.height + random.normal(0, c.height_sd));
      readings_.push_back(
          {f.t, [=, t = f.t, range_sd = std::max(0.01, c.range_sd),
                 bearing_sd = std::max(0.001, to_radians(c.bearing_sd).value)] {
             return fmt::format(
                 "{{\"kind\":\"felled\",\"t\":{:.3f},\"range\":{:.3f},\"bearing\":{:.5f},\"range_sd\":{:.3f},"
                 "\"bearing_sd\":{:.5f},\"features\":{{\"diameter\":{:.3f},\"height\":{:.2f}}}}}\n",
                 t, range, bearing, range_sd, bearing_sd, diameter, height);
           }});
    }
  }

  const DriveWorld& world_;
  const LogCrs& place_;
  std::vector<Reading> readings_;
};

}  // namespace

std::string drive_log(const DriveWorld& world, const LogCrs& place) {
  return LogMaker(world, place).log();
}

std::string true_track(const DriveWorld& world, const LogCrs& place) {
  std::string text = "t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected\n";
  for (const DriveStep& s : world.steps)
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},0,0,0,0,0,0\n", s.t,
                        s.at.plane.x / place.metres_per_unit, s.at.plane.y / place.metres_per_unit, s.at.z,
                        s.at.roll, s.at.pitch, s.at.plane.yaw);
  return text;
}

std::string felled_table(const DriveWorld& world, const LogCrs& place) {
  std::string text = "t,x,y,z,diameter,height,tree\n";
  for (const FelledTree& f : world.felled) {
    const StandingTree& tree = world.trees[f.tree];
    text += fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.2f},{}\n", f.t,
                        tree.foot.x() / place.metres_per_unit, tree.foot.y() / place.metres_per_unit,
                        tree.foot.z(), tree.dbh, tree.height, f.tree);
  }
  return text;
}

std::string standing_table(const DriveWorld& world, const LogCrs& place) {
  std::vector<std::string> felled(world.trees.size());
  for (const FelledTree& f : world.felled) felled[f.tree] = fmt::format("{:.3f}", f.t);
  std::string text = "type,x,y,z,height,diameter,crown_diameter,felled\n";
  for (std::size_t i = 0; i < world.trees.size(); ++i) {
    const StandingTree& tree = world.trees[i];
    text += fmt::format("tree,{:.3f},{:.3f},{:.3f},{:.2f},{:.4f},{:.2f},{}\n",
                        tree.foot.x() / place.metres_per_unit, tree.foot.y() / place.metres_per_unit,
                        tree.foot.z(), tree.height, tree.dbh, tree.crown_diameter, felled[i]);
  }
  return text;
}

}  // namespace waymark::testbed

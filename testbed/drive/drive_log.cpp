// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_log.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/random.hpp"
#include "testbed/drive/drive_readings.hpp"

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
      at_times(world_.settings.stereo.every,
               [&](std::size_t i) { add(i, [this, i] { return depth_line(world_, i, world_.steps[i]); }); });
    if (world_.settings.camera.on)
      at_times(world_.settings.camera.every,
               [&](std::size_t i) { add(i, [this, i] { return camera_line(world_, i, world_.steps[i]); }); });
    if (world_.settings.panorama.on)
      at_times(world_.settings.panorama.every, [&](std::size_t i) {
        add(i, [this, i] { return panorama_line(world_, i, world_.steps[i]); });
      });
    if (world_.settings.gnss.on) gnss();
    crane();
    std::ranges::stable_sort(readings_, {}, &Reading::t);
    std::vector<std::string> lines(readings_.size());
    tbb::parallel_for(std::size_t{0}, readings_.size(),
                      [&](std::size_t i) { lines[i] = readings_[i].line(); });
    std::string text = log_header(world_, place_, world_.steps.front().at.plane, world_.steps);
    for (const std::string& line : lines) text += line;
    return text;
  }

 private:
  void odometry() {
    for (const DriveStep& step : world_.steps)
      readings_.push_back({step.t, [&step, this] { return odometry_lines(world_, place_, step); }});
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
    for (std::size_t m = 0; m < laser_mounts(world_.settings).size(); ++m)
      at_times(world_.settings.laser.every, [&](std::size_t i) {
        add(i, [this, i, m] { return laser_line(world_, i, world_.steps[i], m); });
      });
  }

  void add(std::size_t step, std::function<std::string()> line) {
    readings_.push_back({world_.steps[step].t, std::move(line)});
  }

  void gnss() {
    GnssReceiver receiver(world_.settings.gnss, world_.seed);
    at_times(world_.settings.gnss.every, [&](std::size_t i) {
      readings_.push_back(
          {world_.steps[i].t, [line = receiver.line(world_.steps[i], place_)] { return line; }});
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

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"
namespace waymark::test {

struct MovingSceneOptions {
  std::uint64_t seed = 1;
  int images = 24;
  double interval = 2;         ///< s between images
  double readout_time = 0.08;  ///< s; the camera moves by up to 0.6 m and 3 mrad meanwhile, 7 px
  double wobble = 0;           ///< rad/s, standard deviation of turns that no neighbour shows
  double mark_sd = 0.5;        ///< pixels
  int points = 300;
};

/// Projects a point by a camera that moves while it reads out its rows, by fixed-point iteration on the row.
inline std::optional<Eigen::Vector2d> project_while_moving(const Camera& camera,
                                                           const Eigen::Isometry3d& pose,
                                                           const ShutterMotion& motion,
                                                           const Eigen::Vector3d& point) {
  double row = static_cast<double>(camera.rows - 1) / 2;
  for (int step = 0; step < 50; ++step) {
    const double fraction = row / static_cast<double>(camera.rows - 1) - 0.5;
    const double angle = fraction * motion.turn.norm();
    Eigen::Matrix3d turned = pose.linear();
    if (angle != 0) turned *= Eigen::AngleAxisd(angle, motion.turn.normalized()).toRotationMatrix();
    const auto seen = project(camera, Point<CameraFrame>{turned.transpose() * (point - pose.translation() -
                                                                               fraction * motion.shift)});
    if (!seen || std::abs(seen->y() - row) < 1e-10) return seen;
    row = seen->y();
  }
  return std::nullopt;
}

/// Flight at 100 m along a sine, with swaying attitudes, over the ground of made_scene().
class MovingFlight {
 public:
  static Eigen::Isometry3d pose(double t) {
    const auto wave = [&](double period) { return 2 * std::numbers::pi * t / period; };
    const Eigen::Vector3d centre(50 + 50 * std::sin(wave(40)), 1.5 * t, 100 + 2 * std::sin(wave(17)));
    Eigen::Isometry3d pose = looking_down(centre, 0.05 * std::sin(wave(13)), 0.04 * std::cos(wave(15)));
    pose.linear() *= Eigen::AngleAxisd(0.1 * std::sin(wave(23)), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return pose;
  }
  /// Motion in a time around t, by differences over a millisecond.
  static ShutterMotion motion(double t, double during) {
    const Eigen::Isometry3d before = pose(t - 5e-4), after = pose(t + 5e-4);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
    return {(after.translation() - before.translation()) * 1e3 * during,
            turn.angle() * turn.axis() * 1e3 * during};
  }
};

/// Flight of a rolling shutter with its truth; `start` knows times and readout time, but no motions.
inline MadeScene moving_scene(const MovingSceneOptions& o) {
  Random random(o.seed, "moving");
  MadeScene scene;
  pipeline::Reconstruction& truth = scene.truth;
  truth.frame = pipeline::ReconstructionFrame::metric;
  truth.lenses.push_back({.camera = MadeSceneOptions{}.camera, .readout_time = o.readout_time});
  for (int i = 0; i < o.images; ++i) {
    const double t = o.interval * i;
    ShutterMotion motion = MovingFlight::motion(t, o.readout_time);
    motion.turn += normal_vector(random, o.wobble * o.readout_time);
    truth.images.push_back({.name = fmt::format("image_{:03}", i),
                            .world_from_camera = MovingFlight::pose(t),
                            .time = 1.6e9 + t,
                            .motion = motion});
  }
  const Camera& camera = truth.lenses[0].camera;
  for (int i = 0; i < o.points; ++i) {
    pipeline::TiePoint point;
    const double x = random.uniform(-30, 130), y = random.uniform(-30, 1.5 * o.interval * o.images + 30);
    point.position = Eigen::Vector3d(x, y, ground(x, y, 10));
    for (std::size_t k = 0; k < truth.images.size(); ++k) {
      const auto pixel = project_while_moving(camera, *truth.images[k].world_from_camera,
                                              *truth.images[k].motion, *point.position);
      const double u = random.normal(0, o.mark_sd), v = random.normal(0, o.mark_sd);
      if (!pixel || !((*pixel).minCoeff() > 0) || !(pixel->x() < double(camera.columns)) ||
          !(pixel->y() < double(camera.rows)))
        continue;
      point.marks.push_back({k, *pixel + Eigen::Vector2d(u, v), o.mark_sd > 0 ? o.mark_sd : 1});
    }
    if (point.marks.size() >= 2) truth.points.push_back(point);
  }
  scene.start = truth;
  disturb(scene.start, random);
  for (pipeline::AdjustedImage& image : scene.start.images) image.motion.reset();
  return scene;
}

}  // namespace waymark::test

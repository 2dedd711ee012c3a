// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/flight.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/solve.hpp"

namespace waymark::testbed {
namespace {

Eigen::Vector3d random_vector(Random& random, double sd) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sd * Eigen::Vector3d(x, y, z);
}

// Nadir view with the upper edge towards the heading, then tilted forwards.
Eigen::Matrix3d attitude(const Eigen::Vector2d& forward, double tilt) {
  const Eigen::Vector3d ahead(forward.x(), forward.y(), 0), right(forward.y(), -forward.x(), 0),
      up = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d axes;
  axes.col(0) = right;
  axes.col(1) = -std::cos(tilt) * ahead - std::sin(tilt) * up;
  axes.col(2) = std::sin(tilt) * ahead - std::cos(tilt) * up;
  return axes;
}

// Pixels along the border of the image, corners included.
std::vector<Eigen::Vector2d> border(const Camera& camera) {
  constexpr int kSteps = 16;
  const double right = double(camera.columns) - 0.5, bottom = double(camera.rows) - 0.5;
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = std::lerp(-0.5, right, double(i) / kSteps),
                 y = std::lerp(-0.5, bottom, double(i) / kSteps);
    pixels.insert(pixels.end(), {{x, -0.5}, {x, bottom}, {-0.5, y}, {right, y}});
  }
  return pixels;
}

}  // namespace

Camera camera_of(const Lens& lens) {
  Camera camera;
  camera.columns = lens.columns;
  camera.rows = lens.rows;
  camera.fx = camera.fy = double(lens.columns) / 2 / std::tan(to_radians(lens.field_of_view).value / 2);
  camera.cx = double(lens.columns - 1) / 2;
  camera.cy = double(lens.rows - 1) / 2;
  camera.distortion = {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
  return camera;
}

namespace {

/// Adds a shot at a true pose, reported with the errors of the scenario.
void add_shot(std::vector<Shot>& shots, const Scenario& scenario, const std::string& name,
              const Eigen::Isometry3d& pose, const CameraMotion& motion, Random& errors) {
  const double position_sd = scenario.pose_errors.position_sd;
  const double attitude_sd = to_radians(scenario.pose_errors.attitude_sd).value;
  Shot shot;
  shot.name = name;
  shot.motion = motion;
  shot.view = {.camera = camera_of(scenario.lens), .grid_from_camera = {pose}};
  shot.view.covariance.diagonal() << Eigen::Vector3d::Constant(attitude_sd * attitude_sd),
      Eigen::Vector3d::Constant(position_sd * position_sd);
  shot.reported.transform = pose;
  shot.reported.transform.linear() = pose.linear() * rotation_by(random_vector(errors, attitude_sd));
  shot.reported.transform.translation() += random_vector(errors, position_sd);
  shots.push_back(std::move(shot));
}

void add_lines(std::vector<Shot>& shots, const Scenario& scenario, const Flight& f, Random& errors) {
  const SiteModel& ground = scenario.ground;
  Random random(static_cast<std::uint64_t>(scenario.seed), "flight " + f.name);
  const Eigen::Vector2d from(f.from_east, f.from_north), to(f.to_east, f.to_north);
  const Eigen::Vector2d ahead =
      (to - from).norm() > 0.01 ? Eigen::Vector2d((to - from).normalized()) : Eigen::Vector2d(0, 1);
  const Eigen::Vector2d right(ahead.y(), -ahead.x());
  for (std::int64_t line = 0; line < f.lines; ++line)
    for (std::int64_t i = 0; i < f.images; ++i) {
      const double forth = f.images > 1 ? double(i) / double(f.images - 1) : 0;
      const bool back = line % 2 == 1;
      const double along = back ? 1 - forth : forth;
      const Eigen::Vector2d place = (1 - along) * from + along * to + double(line) * f.line_spacing * right;
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = attitude(back ? Eigen::Vector2d(-ahead) : ahead, to_radians(f.tilt).value) *
                      rotation_by(random_vector(random, to_radians(f.attitude_sd).value));
      const Eigen::Vector3d off = random_vector(random, f.track_sd);
      const double altitude = f.from_altitude * std::pow(f.to_altitude / f.from_altitude, along);
      pose.translation() =
          Eigen::Vector3d(ground.east + place.x(), ground.north + place.y(), ground.up + altitude) + off;
      add_shot(shots, scenario, fmt::format("{}_{:04}.png", f.name, line * f.images + i + 1), pose, {},
               errors);
    }
}

/// Dust below rockets at an altitude: from nothing at dust_altitude to the full depth on the ground.
DustCloud dust_at(const Flight& f, const DescentState& state, double altitude, const Eigen::Vector2d& place,
                  std::uint64_t seed) {
  const double nearness = 1 - altitude / f.dust_altitude;
  if (!(f.dust > 0 && nearness > 0) || state.phase == DescentPhase::parachute) return {};
  return {
      .depth = f.dust * nearness * nearness, .radius = 1.5 * f.dust_altitude, .centre = place, .seed = seed};
}

/// A shield that was released at the start: it falls from 10 m below the lander's first position at a speed
/// that tends to twice the lander's, carried by the wind at half its speed, and tumbles once in 8 s by 20
/// degrees.
FallingShield shield_at(const Flight& f, const std::vector<DescentState>& states, const DescentState& state,
                        const SiteModel& ground) {
  if (!(f.heat_shield > 0)) return {};
  const DescentState& first = states.front();
  const double gravity = f.landing.gravity, terminal = 2 * f.landing.parachute_speed;
  const double start = f.heat_shield_speed - first.body.velocity.z();
  // Quadratic drag with the terminal speed: v' = g (1 - (v / terminal)^2), integrated exactly.
  const double a = std::atanh(std::min(0.999, start / terminal)), k = gravity / terminal;
  const double fallen = terminal / k * std::log(std::cosh(a + k * state.t) / std::cosh(a));
  Eigen::Vector3d centre = first.body.position - Eigen::Vector3d(0, 0, 10 + fallen);
  centre.head<2>() += 0.5 * state.t * first.body.velocity.head<2>();
  if (centre.z() < 0) return {};  // on the ground, out of the lander's way
  const double turn = 2 * std::numbers::pi * state.t / 8;
  const Eigen::Vector3d normal(0.34 * std::cos(turn), 0.34 * std::sin(turn), 1);
  return {.radius = f.heat_shield / 2,
          .centre = centre + Eigen::Vector3d(ground.east, ground.north, ground.up),
          .normal = normal.normalized()};
}

void add_landing(std::vector<Shot>& shots, const Scenario& scenario, const Flight& f, Random& errors) {
  if (f.lines != 1)
    throw Error(ErrorCode::usage, fmt::format("the landing {} has {} lines", f.name, f.lines), "flights",
                "remove lines, or write \"path\": \"lines\"");
  const SiteModel& ground = scenario.ground;
  const std::vector<DescentState> states = simulate_descent(
      f.landing, {f.from_east, f.from_north, f.from_altitude}, {f.to_east, f.to_north, f.to_altitude},
      named_seed(static_cast<std::uint64_t>(scenario.seed), "flight " + f.name));
  for (std::int64_t i = 0; i < f.images; ++i) {
    const double along = f.images > 1 ? double(i) / double(f.images - 1) : 0;
    const DescentState& state =
        states[static_cast<std::size_t>(std::lround(along * double(states.size() - 1)))];
    const RigidBody& body = state.body;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = body.attitude * attitude({1, 0}, to_radians(f.tilt).value);
    pose.translation() = body.position + Eigen::Vector3d(ground.east, ground.north, ground.up);
    add_shot(shots, scenario, fmt::format("{}_{:04}.png", f.name, i + 1), pose,
             {.velocity = body.velocity, .spin = body.attitude * body.spin}, errors);
    Shot& shot = shots.back();
    shot.time = state.t;
    shot.dust = dust_at(f, state, body.position.z(), pose.translation().head<2>(),
                        named_seed(static_cast<std::uint64_t>(scenario.seed), "dust " + shot.name));
    shot.shield = shield_at(f, states, state, ground);
  }
}

}  // namespace

std::vector<Shot> plan_shots(const Scenario& scenario) {
  std::vector<Shot> shots;
  for (const Flight& f : scenario.flights) {
    Random errors(static_cast<std::uint64_t>(scenario.seed), "pose errors " + f.name);
    (f.path == "landing" ? add_landing : add_lines)(shots, scenario, f, errors);
  }
  return shots;
}

View view_of(const Shot& shot) {
  View view = camera_view(shot.view, shot.motion);
  view.dust = shot.dust;
  view.shield = shot.shield;
  return view;
}

PosedCamera true_camera(const Shot& shot, double readout_time) {
  PosedCamera camera = shot.view;
  const Eigen::Matrix3d camera_from_grid = camera.grid_from_camera.transform.linear().transpose();
  if (readout_time > 0)
    camera.motion = {.shift = readout_time * shot.motion.velocity,
                     .turn = readout_time * camera_from_grid * shot.motion.spin};
  return camera;
}

SiteModel size_site(const Scenario& scenario, const std::vector<Shot>& shots) {
  SiteModel ground = scenario.ground;
  if (ground.width > 0 && ground.height > 0) return ground;
  double half_width = 0, half_height = 0;
  for (const Shot& shot : shots)
    for (const Eigen::Vector2d& pixel : border(shot.view.camera)) {
      const auto line = ray(shot.view, pixel);
      if (!line || line->direction.unit.z() > -0.02)
        throw Error(ErrorCode::usage,
                    fmt::format("image {} sees the sky: its footprint is unbounded", shot.name), "",
                    "reduce the tilt or the field of view, or give ground.width and ground.height");
      const double range = (ground.up - line->origin.xyz.z()) / line->direction.unit.z();
      const Eigen::Vector3d spot = line->origin.xyz + range * line->direction.unit;
      half_width = std::max(half_width, std::abs(spot.x() - ground.east));
      half_height = std::max(half_height, std::abs(spot.y() - ground.north));
    }
  const double margin = 3 * ground.relief.rms + 0.1 * std::max(half_width, half_height) + 20 * ground.cell;
  if (!(ground.width > 0)) ground.width = 2 * (half_width + margin);
  if (!(ground.height > 0)) ground.height = 2 * (half_height + margin);
  return ground;
}

void check_footprints(const Scene& scene, const std::vector<Shot>& shots) {
  for (const Shot& shot : shots)
    for (const Eigen::Vector2d& pixel : border(shot.view.camera)) {
      const auto line = ray(shot.view, pixel);
      if (!line)
        throw Error(ErrorCode::usage,
                    fmt::format("the lens of {} cannot be inverted at its border", shot.name),
                    "camera.k1 ... k3", "use weaker distortion or a narrower field of view");
      const RayEnd end = scene.terrain.cast(*line).end;
      if (end == RayEnd::ground) continue;
      throw Error(ErrorCode::usage,
                  fmt::format("image {} {}", shot.name,
                              end == RayEnd::underground ? "is taken from below the terrain"
                                                         : "extends beyond the terrain"),
                  fmt::format("the site is {} x {} m", scene.ground.width, scene.ground.height),
                  "change the path or the altitude of the flight, or omit ground.width and ground.height");
    }
}

}  // namespace waymark::testbed

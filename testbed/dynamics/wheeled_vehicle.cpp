// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/wheeled_vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace waymark::testbed {
namespace {

constexpr double kStep = 0.0025;        // s
constexpr double kSag = 0.02;           // m, of springs and tyres at rest
constexpr double kSettling = 2;         // s, until the body is at rest after it is put down
constexpr double kMinUpright = 0.25;    // cosine between the leg and the normal of a contact
constexpr double kMaxShear = 8;         // lengths of shear: 88 % of the strength and more do not differ
constexpr double kSinkingTime = 0.05;   // s: light wheels would jump on soil that yields at once
constexpr double kSoilDamping = 0.3;    // of the shear of standing wheels, relative to critical
constexpr double kRollingSpeed = 0.01;  // m/s at which the resistance to rolling is full
constexpr double kBellyFriction = 0.5;  // between underside and ground
constexpr double kBellyDepth = 0.02;    // m at which one point of the underside carries the weight
constexpr double kSlidingSpeed = 0.05;  // m/s at which that friction is full
constexpr double kTipped = 0.5;         // cosine of the lean at which a vehicle does not come back

/// Supports of a vehicle relative to the point below its centre of mass.
std::vector<Eigen::Vector2d> positions(const planning::Vehicle& vehicle) {
  std::vector<Eigen::Vector2d> at;
  for (const planning::Support& support : vehicle.supports) at.emplace_back(support.x.value, support.y.value);
  return at;
}

/// What a wheel is commanded: its direction in the body, forwards, and the speed of its rim.
struct Rim {
  Eigen::Vector2d heading{1, 0};
  double speed = 0;
};
Rim commanded(const Eigen::Vector2d& at, double speed, double turn) {
  const Eigen::Vector2d velocity(speed - turn * at.y(), turn * at.x());
  const double size = velocity.norm();
  if (!(size > 1e-9)) return {};
  const double sign = velocity.x() < 0 ? -1 : 1;
  return {sign / size * velocity, sign * size};
}

Eigen::Vector2d limited(const Eigen::Vector2d& force, double strength) {
  const double size = force.norm();
  return size > strength ? Eigen::Vector2d(strength / size * force) : force;
}

/// Returns the shear of the soil after `dt`: it grows by the sliding, and what a rolling wheel leaves behind
/// is replaced within one length of contact.
Eigen::Vector2d sheared(const Eigen::Vector2d& before, const Eigen::Vector2d& sliding, double rim,
                        const WheelFooting& ground, double dt) {
  const double length = std::max(ground.contact_length, 1e-3);
  return limited((before + dt * sliding) / (1 + dt * std::abs(rim) / length),
                 kMaxShear * ground.shear_length);
}

/// Returns the force of sheared soil on a wheel, against the shear.
Eigen::Vector2d traction(const Eigen::Vector2d& shear, const WheelFooting& ground) {
  const double size = shear.norm();
  if (!(size > 0)) return Eigen::Vector2d::Zero();
  return -ground.strength * mobilized_fraction(size, ground.shear_length) / size * shear;
}

/// A wheel and its contact, between the two halves of a step.
struct Footing {
  Eigen::Vector3d normal, point, along, across;
  double rim = 0;
};

}  // namespace

WheeledVehicle::WheeledVehicle(const planning::Vehicle& vehicle, const Soil& soil, double gravity,
                               const DrivingSurface& surface, const localization::Pose2& start)
    : surface_(surface),
      soil_(soil),
      gravity_(gravity),
      height_(vehicle.centre_of_mass.value),
      clearance_(vehicle.belly_clearance.value),
      suspension_(positions(vehicle), vehicle.suspension, std::max(vehicle.mass, 1e-3), gravity, kSag) {
  if (!(vehicle.mass > 0 && height_ > 0))
    throw Error(ErrorCode::usage,
                fmt::format("the vehicle {} has no mass, which its dynamics need", vehicle.name), "",
                R"(add "mass" (kg) and "centre_of_mass" (metres above the ground) to its file)");
  Eigen::Vector3d size(0, 0, 1.2 * height_);
  for (const planning::Support& s : vehicle.supports) {
    wheels_.push_back({.at = {s.x.value, s.y.value}, .radius = s.diameter.value / 2, .width = s.width.value});
    size.x() = std::max(size.x(), 2 * std::abs(s.x.value) + s.diameter.value);
    size.y() = std::max(size.y(), 2 * std::abs(s.y.value) + s.width.value);
  }
  body_.mass = vehicle.mass;
  body_.inertia = box_inertia(vehicle.mass, size);
  const auto stands = localization::pose_on_terrain(
      [&](const Eigen::Vector2d& p) -> std::optional<double> {
        const auto point = surface_.at(p);
        return point ? std::optional(point->height) : std::nullopt;
      },
      start, {.base = size.x(), .track = size.y()});
  if (!stands)
    throw Error(ErrorCode::usage,
                fmt::format("the drive begins outside the terrain, at {:.1f}, {:.1f}", start.x, start.y),
                "drive", "enlarge the site (ground.width, ground.height), or move the waypoints");
  const Eigen::Isometry3d pose = stands->grid_from_robot().transform;
  body_.attitude = Eigen::Quaterniond(pose.linear());
  body_.position = pose * Eigen::Vector3d(0, 0, height_);
  drive(0, 0, kSettling);
  body_.velocity.setZero(), body_.spin.setZero();
}

void WheeledVehicle::drive(double speed, double turn, double seconds) {
  const auto steps = static_cast<int>(std::ceil(seconds / kStep));
  for (int i = 0; i < steps && !tipped_over(); ++i) step(speed, turn, seconds / steps);
}

void WheeledVehicle::step(double speed, double turn, double dt) {
  const Eigen::Matrix3d axes = body_.attitude.toRotationMatrix();
  const Eigen::Vector3d up = axes.col(2);
  std::vector<Suspension::Contact> contacts;
  std::vector<Footing> footings;
  for (Wheel& wheel : wheels_) {
    const Rim rim = commanded(wheel.at, speed, turn);
    const Eigen::Vector3d below(wheel.at.x(), wheel.at.y(), -height_);
    const Eigen::Vector3d centre = body_.point(below) + wheel.radius * up;
    const Eigen::Vector3d heading = axes.leftCols<2>() * rim.heading;
    const auto touch =
        surface_.lower_wheel(centre.head<2>(), heading.head<2>().normalized(), wheel.radius, wheel.width);
    if (!touch)
      throw Error(ErrorCode::usage,
                  fmt::format("the drive leaves the terrain at {:.1f}, {:.1f}", centre.x(), centre.y()),
                  "drive", "enlarge the site (ground.width, ground.height), or move the waypoints");
    wheel.on_rock = touch->on_rock;
    const Eigen::Vector3d& normal = touch->normal;
    const double upright = std::max(kMinUpright, normal.dot(up));
    const Eigen::Vector3d velocity = body_.velocity_at(below);
    contacts.push_back({.lift = (touch->height + wheel.radius - centre.z()) / up.z() - wheel.sinkage,
                        .speed = -velocity.dot(normal) / upright});
    const Eigen::Vector3d along = (heading - heading.dot(normal) * normal).normalized();
    footings.push_back({.normal = normal,
                        .point = centre - wheel.radius * normal,
                        .along = along,
                        .across = normal.cross(along),
                        .rim = rim.speed});
  }
  const std::vector<double> loads = suspension_.forces(contacts, dt);

  Wrench wrench = belly_forces();
  wrench.force.z() -= body_.mass * gravity_;
  const double carried = body_.mass / static_cast<double>(wheels_.size());
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    Wheel& wheel = wheels_[i];
    const Footing& f = footings[i];
    wheel.load = loads[i];
    if (!(wheel.load > 0)) {
      wheel.shear.setZero(), wheel.slip = 0;
      wheel.sinkage -= dt / kSinkingTime * wheel.sinkage;
      continue;
    }
    const double upright = std::max(kMinUpright, f.normal.dot(up)), push = wheel.load / upright;
    const WheelFooting ground = wheel_footing(soil_, push, wheel.radius, wheel.width, wheel.on_rock);
    wheel.sinkage += dt / kSinkingTime * (ground.sinkage - wheel.sinkage);
    const Eigen::Vector3d velocity =
        body_.velocity_at(body_.attitude.conjugate() * (f.point - body_.position));
    const double forward = velocity.dot(f.along);
    const Eigen::Vector2d sliding(forward - f.rim, velocity.dot(f.across));
    wheel.slip = f.rim != 0 ? 1 - forward / f.rim : 0;
    wheel.shear = sheared(wheel.shear, sliding, f.rim, ground, dt);
    Eigen::Vector2d force = traction(wheel.shear, ground);
    if (f.rim == 0) {
      const double damping =
          2 * kSoilDamping * std::sqrt(ground.strength / (2 * ground.shear_length) * carried);
      force = limited(force - damping * sliding, ground.strength);
    }
    // Full against the rolling, also of wheels that spin on the spot; reversed for those that slide back.
    const double sense = f.rim == 0 ? 0 : std::copysign(1.0, f.rim);
    const double rolling = std::clamp(sense + forward / kRollingSpeed, -1.0, 1.0);
    force.x() -= ground.resistance * rolling;
    // On the front of a rock the pull of the wheel carries a part of its load.
    const Eigen::Vector3d pull = force.x() * f.along + force.y() * f.across;
    const double carrying = std::max(kMinUpright, upright + pull.dot(up) / push) / upright;
    wrench.add(body_, (push * f.normal + pull) / carrying, f.point);
  }
  advance(body_, wrench, dt);
}

Wrench WheeledVehicle::belly_forces() const {
  Wrench wrench;
  double front = 0, side = 0;
  for (const Wheel& wheel : wheels_)
    front = std::max(front, wheel.at.x()), side = std::max(side, wheel.at.y() - wheel.width);
  const double weight = body_.mass * gravity_, stiffness = weight / kBellyDepth;
  const double damping = std::sqrt(stiffness * body_.mass);
  for (const double along : {-1.0, 0.0, 1.0})
    for (const double across : {-1.0, 0.0, 1.0}) {
      const Eigen::Vector3d below(along * front, across * side, clearance_ - height_);
      const Eigen::Vector3d at = body_.point(below);
      const auto ground = surface_.at(at.head<2>());
      if (!ground || ground->height <= at.z()) continue;
      const Eigen::Vector3d velocity = body_.velocity_at(below);
      const double closing = -velocity.dot(ground->normal);
      const double push =
          std::max(0.0, stiffness * (ground->height - at.z()) * ground->normal.z() + damping * closing);
      const Eigen::Vector3d slide = velocity + closing * ground->normal;
      wrench.add(body_,
                 push * (ground->normal - kBellyFriction * slide / std::max(kSlidingSpeed, slide.norm())),
                 at);
    }
  return wrench;
}

localization::TerrainPose WheeledVehicle::pose() const {
  const Eigen::Matrix3d axes = body_.attitude.toRotationMatrix();
  const Eigen::Vector3d foot = body_.point({0, 0, -height_});
  return {.plane = {foot.x(), foot.y(), std::atan2(axes(1, 0), axes(0, 0))},
          .z = foot.z(),
          .roll = std::atan2(axes(2, 1), axes(2, 2)),
          .pitch = std::asin(std::clamp(-axes(2, 0), -1.0, 1.0))};
}

bool WheeledVehicle::grounded() const {
  return belly_forces().force.z() > 0;
}

bool WheeledVehicle::tipped_over() const {
  return body_.attitude.toRotationMatrix()(2, 2) < kTipped;
}

}  // namespace waymark::testbed

// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/descent.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::testbed {
namespace {

constexpr double kDescentStep = 0.005;  // s
constexpr int kStepsPerState = 4;       // 50 states per second
constexpr double kMass = 1000;          // kg
constexpr double kLine = 25;            // m, from the centre of mass to the parachute
constexpr double kAir = 50;             // kg that move with the parachute
constexpr double kAlongWind = 0.25;     // fraction of the drag that acts against the wind, not along the line
constexpr double kGustTime = 2;         // s, correlation time of gusts
constexpr double kCraneSpeed = 0.75;    // m/s
constexpr double kMaxThrust = 4;        // of the weight
constexpr double kMaxLean = 0.6;        // rad, of the thrust
constexpr double kTurning = 3;          // rad/s, natural frequency of the control of attitude
constexpr double kMaxSeconds = 3600;

class Descent {
 public:
  Descent(const DescentModel& model, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
          std::uint64_t seed)
      : model_(model), to_(to), random_(seed, "descent") {
    const double direction = random_.uniform(0, 2 * std::numbers::pi),
                 side = random_.uniform(0, 2 * std::numbers::pi);
    wind_ = model.wind * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0);
    const double yaw = random_.uniform(0, 2 * std::numbers::pi);
    RigidBody& body = state_.body;
    body.mass = kMass + kAir;
    body.inertia = Eigen::Vector3d(kAir * kLine * kLine, kAir * kLine * kLine, 800);
    body.position = from;
    body.velocity = wind_ - model.parachute_speed * Eigen::Vector3d::UnitZ();
    const double swing = to_radians(model.swing).value;
    body.attitude = Eigen::AngleAxisd(swing, Eigen::Vector3d(std::cos(side), std::sin(side), 0)) *
                    Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  }

  std::vector<DescentState> run() {
    std::vector<DescentState> states{state_};
    for (long step = 1; state_.body.position.z() > to_.z(); ++step) {
      advance_phase();
      advance(state_.body, forces(), kDescentStep);
      state_.t = static_cast<double>(step) * kDescentStep;
      if (step % kStepsPerState == 0) states.push_back(state_);
      if (state_.t > kMaxSeconds)
        throw Error(ErrorCode::usage, "the landing does not reach the ground within an hour", "flights",
                    "a parachute_speed above the speed of the wind, or lower altitudes");
    }
    return states;
  }

 private:
  void advance_phase() {
    RigidBody& body = state_.body;
    if (state_.phase == DescentPhase::parachute && body.position.z() < model_.powered_altitude) {
      state_.phase = DescentPhase::powered;
      body.mass = kMass;
      body.inertia = {900, 900, 800};
      const double fall = body.position.z() - model_.crane_altitude;
      remaining_ = 2.5 * fall / (std::abs(body.velocity.z()) + kCraneSpeed);
    }
    if (state_.phase == DescentPhase::powered &&
        (remaining_ < 0.2 || body.position.z() < model_.crane_altitude))
      state_.phase = DescentPhase::crane;
  }

  Wrench forces() {
    Wrench wrench;
    wrench.force.z() = -state_.body.mass * model_.gravity;
    if (state_.phase == DescentPhase::parachute)
      parachute(wrench);
    else
      rockets(wrench);
    return wrench;
  }

  void parachute(Wrench& wrench) {
    RigidBody& body = state_.body;
    const double fade = std::exp(-kDescentStep / kGustTime),
                 fresh = std::sqrt(1 - fade * fade) * model_.wind / 3;
    for (double& gust : gust_) gust = fade * gust + random_.normal(0, fresh);
    const Eigen::Vector3d canopy(0, 0, kLine);
    const Eigen::Vector3d air = body.velocity_at(canopy) - wind_ - gust_;
    const Eigen::Vector3d line = body.attitude * Eigen::Vector3d::UnitZ();
    const double speed = air.norm();
    const double drag = body.mass * model_.gravity * std::pow(speed / model_.parachute_speed, 2);
    if (speed > 0)
      wrench.add(body, drag * ((1 - kAlongWind) * line - kAlongWind / speed * air), body.point(canopy));
    body.spin.z() = to_radians(model_.spin).value;
  }

  void rockets(Wrench& wrench) {
    const RigidBody& body = state_.body;
    const Eigen::Vector3d off = Eigen::Vector3d(to_.x(), to_.y(), model_.crane_altitude) - body.position;
    const Eigen::Vector3d end(0, 0, -kCraneSpeed);
    Eigen::Vector3d acceleration;
    if (state_.phase == DescentPhase::powered) {
      acceleration = 6 * off / (remaining_ * remaining_) - (4 * body.velocity + 2 * end) / remaining_;
      remaining_ -= kDescentStep;
    } else {
      acceleration = Eigen::Vector3d(0.3 * off.x(), 0.3 * off.y(), 0) + 1.2 * (end - body.velocity);
    }
    Eigen::Vector3d thrust = body.mass * (acceleration + Eigen::Vector3d(0, 0, model_.gravity));
    const double weight = body.mass * model_.gravity;
    thrust.z() = std::max(thrust.z(), 0.1 * weight);
    const double sideways = thrust.head<2>().norm(), max_sideways = thrust.z() * std::tan(kMaxLean);
    if (sideways > max_sideways) thrust.head<2>() *= max_sideways / sideways;
    if (thrust.norm() > kMaxThrust * weight) thrust *= kMaxThrust * weight / thrust.norm();
    // The engines push along the axis; a moment turns the axis to the wanted thrust.
    const Eigen::Vector3d axis = body.attitude * Eigen::Vector3d::UnitZ();
    wrench.force += thrust.norm() * axis;
    const Eigen::Vector3d error = axis.cross(thrust.normalized());
    const Eigen::Vector3d spin = body.attitude * body.spin;
    wrench.moment += body.inertia.x() * (kTurning * kTurning * error - 2 * kTurning * spin);
  }

  const DescentModel& model_;
  Eigen::Vector3d to_;
  Random random_;
  DescentState state_;
  Eigen::Vector3d wind_ = Eigen::Vector3d::Zero(), gust_ = Eigen::Vector3d::Zero();
  double remaining_ = 0;  // s of the powered phase
};

}  // namespace

void DescentModel::describe(OptionVisitor& option) {
  option("powered_altitude", powered_altitude,
         {.help = "Landing: metres above the mean height at which rockets replace the parachute",
          .min = 1,
          .max = 1e5});
  option(
      "crane_altitude", crane_altitude,
      {.help = "Landing: metres from which on the descent is straight, at 0.75 m/s", .min = 0.1, .max = 1e4});
  option("parachute_speed", parachute_speed,
         {.help = "Landing: steady speed under the parachute, metres per second", .min = 1, .max = 500});
  option("swing", swing,
         {.help = "Landing: angle of the first swing under the parachute", .min = 0, .max = 45});
  option("wind", wind, {.help = "Landing: mean wind, metres per second", .min = 0, .max = 100});
  option("spin", spin,
         {.help = "Landing: turn per second about the vertical axis under the parachute",
          .min = -90,
          .max = 90});
  option("gravity", gravity, {.help = "Landing: metres per second squared", .min = 0.01, .max = 30});
}

std::vector<DescentState> simulate_descent(const DescentModel& model, const Eigen::Vector3d& from,
                                           const Eigen::Vector3d& to, std::uint64_t seed) {
  if (!(from.z() > to.z() && model.powered_altitude > model.crane_altitude && model.crane_altitude >= to.z()))
    throw Error(
        ErrorCode::usage,
        fmt::format("a landing from {:g} m to {:g} m with rockets from {:g} m and a crane from {:g} m",
                    from.z(), to.z(), model.powered_altitude, model.crane_altitude),
        "flights", "altitudes fall: from_altitude, powered_altitude, crane_altitude, to_altitude");
  return Descent(model, from, to, seed).run();
}

}  // namespace waymark::testbed

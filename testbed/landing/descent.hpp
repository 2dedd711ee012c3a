// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
#include "testbed/dynamics/rigid_body.hpp"
namespace waymark::testbed {

/// Landing under a parachute, by rockets and by a sky crane, as that of Perseverance in 2021 (defaults).
struct DescentModel {
  double powered_altitude = 1900;  ///< m above the site: the parachute is released, the rockets start
  double crane_altitude = 20;      ///< m: from here on straight down at 0.75 m/s
  double parachute_speed = 85;     ///< m/s, at which drag carries the weight
  Degrees swing{8};                ///< angle of the first swing under the parachute
  double wind = 8;                 ///< m/s, mean; gusts of a third of it
  Degrees spin{2};                 ///< per second, about the vertical axis under the parachute
  double gravity = 3.71;           ///< m/s^2

  void describe(OptionVisitor& option);
};

enum class DescentPhase { parachute, powered, crane };

struct DescentState {
  double t = 0;  ///< s from the start
  DescentPhase phase = DescentPhase::parachute;
  RigidBody body;  ///< z axis up, towards the parachute
};

/// Simulates a landing from rest relative to the wind at `from` to `to`, both metres with z above the site,
/// at 50 states per second. The rockets steer to the position of `to`; the descent ends at its height.
/// Deterministic for a seed.
/// - Parachute: a rigid line of 25 m with 50 kg of air at its end; three quarters of the drag act along the
///   line, one quarter against the wind, which lets it swing.
/// - Rockets: an acceleration linear in time that meets position and velocity (E guidance, Cherry 1964); the
///   body is turned to the thrust within a second.
/// Throws Error{usage} if an altitude is not above the next one.
std::vector<DescentState> simulate_descent(const DescentModel& model, const Eigen::Vector3d& from,
                                           const Eigen::Vector3d& to, std::uint64_t seed);

}  // namespace waymark::testbed

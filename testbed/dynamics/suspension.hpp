// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>
namespace waymark::testbed {

/// Massless suspension of a vehicle. Each wheel has a spring and a damper along the vertical axis of the
/// body; rockers and bogies turn freely until the moments of their wheels balance.
class Suspension {
 public:
  /// Throws Error{usage} if the wheels do not suit the kind.
  /// - `wheels`: positions forwards and to the left of the centre of mass, metres.
  /// - `kind`: rigid, rocker_bogie or bogie (planning/vehicle.hpp). In a rocker_bogie, the two rear wheels of
  /// a
  ///   side share a bogie, the front wheel and the bogie a rocker; a differential turns the rockers against
  ///   each other. In a bogie, the two front wheels of a side share one, of four also the two rear wheels.
  /// - `mass`: kg. `gravity`: m/s^2. `sag`: m, compression of the springs at rest.
  Suspension(std::span<const Eigen::Vector2d> wheels, const std::string& kind, double mass, double gravity,
             double sag);

  /// Ground below one wheel.
  struct Contact {
    double lift =
        0;  ///< m, height of the ground above the plane of the wheels at rest, along the body's axis
    double speed = 0;  ///< m/s, at which it rises relative to the body
  };

  /// Returns the force of each wheel along the body's vertical axis, N; 0 for wheels in the air. Turns the
  /// links for `dt` seconds.
  std::vector<double> forces(std::span<const Contact> contacts, double dt);

  /// Returns the angles of rockers and bogies, rad.
  const Eigen::VectorXd& link_angles() const { return angles_; }
  /// Returns the stiffness of the spring of a wheel, N/m.
  double stiffness() const { return stiffness_; }

 private:
  Eigen::MatrixXd lift_per_angle_;  // wheels x links
  Eigen::VectorXd rest_loads_;      // N
  Eigen::VectorXd angles_;
  double stiffness_ = 0, damping_ = 0;
};

}  // namespace waymark::testbed

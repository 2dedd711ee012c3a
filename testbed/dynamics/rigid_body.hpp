// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
namespace waymark::testbed {

/// Rigid body with six degrees of freedom. Positions and velocities in GridFrame (z up), spin in body axes.
struct RigidBody {
  double mass = 1;                                     ///< kg
  Eigen::Vector3d inertia = Eigen::Vector3d::Ones();   ///< kg m^2, principal moments about the body axes
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, centre of mass
  Eigen::Quaterniond attitude{1, 0, 0, 0};             ///< grid from body
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< rad/s, body axes

  /// Returns the position of a point given in body axes relative to the centre of mass.
  Eigen::Vector3d point(const Eigen::Vector3d& body) const { return position + attitude * body; }
  /// Returns the velocity of such a point, m/s in GridFrame.
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& body) const {
    return velocity + attitude * spin.cross(body);
  }
};

/// Sum of the forces on a body, N and N m in GridFrame, the moments about its centre of mass.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  /// Adds a force that acts at a position of GridFrame.
  void add(const RigidBody& body, const Eigen::Vector3d& newtons, const Eigen::Vector3d& at) {
    force += newtons;
    moment += (at - body.position).cross(newtons);
  }
};

/// Returns the principal moments of a homogeneous box, kg m^2. `size`: metres along the body axes.
Eigen::Vector3d box_inertia(double mass, const Eigen::Vector3d& size);

/// Advances a body by `dt` seconds under constant forces: semi-implicit Euler, the rotation by its
/// exponential map with Euler's gyroscopic moment. First order in time; stable while dt times the highest
/// natural frequency, rad/s, is below 1.
void advance(RigidBody& body, const Wrench& wrench, double dt);

}  // namespace waymark::testbed

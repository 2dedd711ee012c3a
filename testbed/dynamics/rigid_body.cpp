// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/rigid_body.hpp"

#include <cmath>

namespace waymark::testbed {

Eigen::Vector3d box_inertia(double mass, const Eigen::Vector3d& size) {
  const Eigen::Vector3d squares = size.cwiseAbs2();
  return mass / 12 * (Eigen::Vector3d::Constant(squares.sum()) - squares);
}

void advance(RigidBody& body, const Wrench& wrench, double dt) {
  body.velocity += dt / body.mass * wrench.force;
  body.position += dt * body.velocity;
  const Eigen::Vector3d momentum = body.inertia.cwiseProduct(body.spin);
  const Eigen::Vector3d moment = body.attitude.conjugate() * wrench.moment - body.spin.cross(momentum);
  body.spin += dt * moment.cwiseQuotient(body.inertia);
  const double angle = dt * body.spin.norm();
  if (angle > 0)
    body.attitude =
        (body.attitude * Eigen::Quaterniond(Eigen::AngleAxisd(angle, body.spin.normalized()))).normalized();
}

}  // namespace waymark::testbed

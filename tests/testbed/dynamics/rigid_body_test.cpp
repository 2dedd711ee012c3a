// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/rigid_body.hpp"

#include <gtest/gtest.h>

namespace waymark::test {
using namespace testbed;
namespace {

TEST(RigidBody, FallsAsGravityDemands) {
  RigidBody body{.mass = 3, .velocity = {2, 0, 5}};
  Wrench weight;
  weight.add(body, {0, 0, -3 * 3.71}, body.position);
  for (int i = 0; i < 1000; ++i) advance(body, weight, 0.002);
  EXPECT_NEAR(body.position.x(), 4, 1e-9);
  EXPECT_NEAR(body.position.z(), 5 * 2 - 3.71 * 2 * 2 / 2, 0.01);
  EXPECT_NEAR(body.velocity.z(), 5 - 3.71 * 2, 1e-9);
}

TEST(RigidBody, SpinsFreelyWithItsAngularMomentumAndEnergy) {
  RigidBody body{.mass = 2, .inertia = box_inertia(2, {1, 2, 3}), .spin = {0.3, 1.2, 0.2}};
  const auto momentum = [&] { return Eigen::Vector3d(body.attitude * body.inertia.cwiseProduct(body.spin)); };
  const auto energy = [&] { return body.spin.dot(body.inertia.cwiseProduct(body.spin)) / 2; };
  const Eigen::Vector3d momentum_before = momentum();
  const double energy_before = energy();
  double largest_turn = 0;
  for (int i = 0; i < 20000; ++i) {
    advance(body, {}, 0.0005);
    largest_turn = std::max(largest_turn, body.attitude.angularDistance(Eigen::Quaterniond::Identity()));
  }
  EXPECT_GT(largest_turn, 2) << "it does turn";
  EXPECT_LT((momentum() - momentum_before).norm(), 0.01 * momentum_before.norm());
  EXPECT_NEAR(energy(), energy_before, 0.01 * energy_before);
}

TEST(RigidBody, TurnsAboutItsAxisUnderAForceOffTheCentre) {
  RigidBody body{.mass = 1, .inertia = {1, 1, 4}};
  for (int i = 0; i < 1000; ++i) {
    Wrench push;
    push.add(body, body.attitude * Eigen::Vector3d(0, 2, 0), body.point({0.5, 0, 0}));
    advance(body, push, 0.001);
  }
  EXPECT_NEAR(body.spin.z(), 2 * 0.5 / 4, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(body.attitude).angle(), 0.25 / 2, 1e-3);
}

TEST(RigidBody, HasTheMomentsOfABox) {
  const Eigen::Vector3d moments = box_inertia(12, {1, 2, 3});
  EXPECT_NEAR((moments - Eigen::Vector3d(13, 10, 5)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace waymark::test

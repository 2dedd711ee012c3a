// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/suspension.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

using ::testing::HasSubstr;

constexpr double kMass = 900, kGravity = 3.71, kSag = 0.02;

std::vector<Eigen::Vector2d> six_wheels() {
  return {{1.1, 1.2}, {1.1, -1.2}, {0, 1.2}, {0, -1.2}, {-1.1, 1.2}, {-1.1, -1.2}};
}

/// Returns the loads after the links have come to rest.
std::vector<double> settled(Suspension& suspension, const std::vector<double>& lifts) {
  std::vector<Suspension::Contact> contacts;
  for (const double lift : lifts) contacts.push_back({.lift = lift});
  for (int i = 0; i < 2000; ++i) suspension.forces(contacts, 0.0025);
  return suspension.forces(contacts, 0.0025);
}

TEST(Suspension, CarriesTheWeightAtRest) {
  for (const char* kind : {"rigid", "rocker_bogie", "bogie"}) {
    Suspension suspension(six_wheels(), kind, kMass, kGravity, kSag);
    const std::vector<double> loads = settled(suspension, std::vector<double>(6));
    EXPECT_NEAR(std::accumulate(loads.begin(), loads.end(), 0.0), kMass * kGravity, 1e-6) << kind;
    double moment = 0;
    for (std::size_t i = 0; i < 6; ++i) moment += loads[i] * six_wheels()[i].x();
    EXPECT_NEAR(moment, 0, 1e-6) << kind;
    EXPECT_LT(suspension.link_angles().norm(), 1e-9) << kind;
  }
}

// What bogies and the differential are for: loads in balance on any ground.
TEST(Suspension, RockersAndBogiesBalanceLoadsOnUnevenGround) {
  Random random(5);
  int compared = 0;
  for (int round = 0; round < 30; ++round) {
    std::vector<double> lifts(6);
    for (double& lift : lifts) lift = random.uniform(-0.1, 0.1);
    Suspension rocker(six_wheels(), "rocker_bogie", kMass, kGravity, kSag);
    const std::vector<double> loads = settled(rocker, lifts);
    if (std::ranges::min(loads) <= 0) continue;
    ++compared;
    double rockers[2] = {};
    for (const std::size_t side : {0u, 1u}) {
      EXPECT_NEAR(loads[side + 2], loads[side + 4], 1) << "the two wheels of a bogie";
      rockers[side] = 1.1 * loads[side] - 0.55 * (loads[side + 2] + loads[side + 4]);
    }
    EXPECT_NEAR(rockers[0], rockers[1], 1) << "the two ends of the differential";
  }
  EXPECT_GT(compared, 3);
}

TEST(Suspension, AWheelInTheAirCarriesNothing) {
  Suspension suspension(six_wheels(), "rigid", kMass, kGravity, kSag);
  const std::vector<double> loads = settled(suspension, {0, 0, 0, 0, 0, -0.5});
  EXPECT_EQ(loads[5], 0);
  EXPECT_GT(loads[4], 0);
}

TEST(Suspension, FallingWheelsAreDamped) {
  Suspension suspension(six_wheels(), "rigid", kMass, kGravity, kSag);
  const std::vector<Suspension::Contact> still(6), closing(6, {.lift = 0, .speed = 0.1});
  EXPECT_GT(suspension.forces(closing, 0.0025)[0], suspension.forces(still, 0.0025)[0]);
}

std::string refusal(const std::vector<Eigen::Vector2d>& wheels, const char* kind) {
  try {
    Suspension(wheels, kind, kMass, kGravity, kSag);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Suspension, NeedsWheelsThatSuitIt) {
  const std::vector<Eigen::Vector2d> four{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  EXPECT_EQ(refusal(four, "rigid"), "accepted");
  EXPECT_THAT(refusal(four, "rocker_bogie"), HasSubstr("needs three wheels on each side"));
  EXPECT_THAT(refusal(four, "bogie"), HasSubstr("needs three wheels or more"));
  EXPECT_THAT(refusal({{1, 1}, {1, -1}, {0.5, 1}, {0.5, -1}}, "rigid"), HasSubstr("centre of mass"));
}

}  // namespace
}  // namespace waymark::test

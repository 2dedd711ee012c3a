// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/soil.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

/// Returns the load that a wheel bears at a sinkage: Bekker's pressure summed along the contact.
double load_at(const Soil& soil, double sinkage, double radius, double width) {
  constexpr int kParts = 20000;
  const double length = std::sqrt(2 * radius * sinkage);
  double load = 0;
  for (int i = 0; i < kParts; ++i) {
    const double x = (i + 0.5) * length / kParts;
    load += soil.stiffness * (sinkage - x * x / (2 * radius)) * width * length / kParts;
  }
  return load;
}

TEST(Soil, BearsTheLoadAtTheSinkageOfTheWheel) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Soil soil{.stiffness = random.uniform(5e5, 5e6)};
    const double radius = random.uniform(0.1, 0.8), width = random.uniform(0.1, 0.6);
    const double load = random.uniform(20, 2000);
    const WheelFooting footing = wheel_footing(soil, load, radius, width, false);
    if (footing.sinkage > 0.45 * radius) continue;
    EXPECT_NEAR(load_at(soil, footing.sinkage, radius, width), load, 1e-3 * load);
    EXPECT_NEAR(footing.contact_length, std::sqrt(2 * radius * footing.sinkage), 1e-12);
  }
}

TEST(Soil, SumsTheShearAlongTheContact) {
  for (const double displacement : {1e-6, 0.001, 0.02, 0.3}) {
    constexpr int kParts = 20000;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) sum += 1 - std::exp(-(i + 0.5) / kParts * displacement / 0.018);
    EXPECT_NEAR(mobilized_fraction(displacement, 0.018), sum / kParts, 1e-7) << displacement;
    EXPECT_EQ(mobilized_fraction(-displacement, 0.018), mobilized_fraction(displacement, 0.018));
  }
  EXPECT_EQ(mobilized_fraction(0, 0.018), 0);
}

TEST(Soil, SlipPullsAsMuchAsWasAskedFor) {
  const WheelFooting footing = wheel_footing({}, 500, 0.26, 0.4, false);
  double before = 0;
  for (const double fraction : {0.1, 0.3, 0.5, 0.7}) {
    const double slip = slip_of_pull(fraction, footing);
    EXPECT_NEAR(mobilized_fraction(slip * footing.contact_length, footing.shear_length), fraction, 1e-9);
    EXPECT_GT(slip, before);
    before = slip;
  }
  EXPECT_EQ(slip_of_pull(0, footing), 0);
  EXPECT_EQ(slip_of_pull(0.99, footing), 1);
}

TEST(Soil, RocksAreHard) {
  const WheelFooting footing = wheel_footing({.rock_friction = 0.6}, 500, 0.26, 0.4, true);
  EXPECT_EQ(footing.sinkage, 0);
  EXPECT_NEAR(footing.strength, 300, 1e-9);
}

TEST(Soil, WithoutALoadNothingHolds) {
  const WheelFooting footing = wheel_footing({}, -5, 0.26, 0.4, false);
  EXPECT_EQ(footing.sinkage, 0);
  EXPECT_EQ(footing.strength, 0);
}

}  // namespace
}  // namespace waymark::test

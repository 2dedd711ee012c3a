// SPDX-License-Identifier: Apache-2.0
// Made sites: a catalogue of craters, and a map of a part of it with false, missing and inaccurate craters.
#include "localization/registration/register_circles.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::HasSubstr;

constexpr double kSide = 40'000, kMapSide = 9'000;

struct Site {
  std::vector<Circle> map = {}, catalogue = {};
  PlaneSimilarity truth = {};
};

Circle crater(Random& random, double side) {
  Circle c;
  c.at = {random.uniform(0, side), random.uniform(0, side)};
  c.diameter = 300 / std::sqrt(1 - 0.99 * random.uniform());  // cumulative number as D^-2
  c.position_sd = 0.03 * c.diameter;
  c.log_diameter_sd = 0.08;
  return c;
}

Circle disturbed(Circle c, Random& random) {
  c.at += c.position_sd * Eigen::Vector2d(random.normal(), random.normal());
  c.diameter *= std::exp(random.normal(0, c.log_diameter_sd));
  return c;
}

// `from` chooses the terrain of the map; another number than `seed` is terrain that the catalogue lacks.
Site made_site(std::uint64_t seed, std::uint64_t from) {
  Site site;
  std::vector<Circle> terrain;
  for (const std::uint64_t s : {seed, from}) {
    Random random(s, "terrain");
    terrain.clear();
    for (int i = 0; i < 400; ++i) terrain.push_back(crater(random, kSide));
    Random errors(s, "catalogue");
    if (site.catalogue.empty())
      for (const Circle& c : terrain) site.catalogue.push_back(disturbed(c, errors));
  }
  Random random(seed, "map");
  site.truth.log_scale = random.uniform(-0.4, 0.4);
  site.truth.yaw = random.uniform(-3.1, 3.1);
  site.truth.shift = {random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4)};
  const Eigen::Vector2d corner(random.uniform(0, kSide - kMapSide), random.uniform(0, kSide - kMapSide));
  const Eigen::Matrix2d back = site.truth.linear().inverse();
  const double scale = std::exp(site.truth.log_scale);
  const auto add = [&](const Circle& on_terrain) {
    Circle c = disturbed(on_terrain, random);
    c.at = back * (c.at - site.truth.shift);
    c.diameter /= scale;
    c.position_sd /= scale;
    site.map.push_back(c);
  };
  for (const Circle& c : terrain) {
    const Eigen::Vector2d inside = c.at - corner;
    if (inside.minCoeff() > 0 && inside.maxCoeff() < kMapSide && random.bernoulli(0.8)) add(c);
  }
  const std::size_t seen = site.map.size();
  for (std::size_t i = 0; i < seen / 3; ++i) {
    Circle c = crater(random, kMapSide);
    c.at += corner;
    add(c);
  }
  return site;
}

double error_in_middle(const Site& site, const CircleFit& fit) {
  const Eigen::Vector2d middle =
      fit.catalogue_from_map.linear().inverse() * (fit.pivot - fit.catalogue_from_map.shift);
  return (fit.catalogue_from_map * middle - site.truth * middle).norm();
}

TEST(RegisterCircles, PlacesMapsWithHonestCovariance) {
  int found = 0;
  double squares = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    const Site site = made_site(seed, seed);
    const CircleRegistration placed = register_circles(site.map, site.catalogue);
    if (!placed.fit) continue;
    ++found;
    const CircleFit& fit = *placed.fit;
    EXPECT_LT(error_in_middle(site, fit), 150) << "seed " << seed;
    const Eigen::Vector2d middle =
        fit.catalogue_from_map.linear().inverse() * (fit.pivot - fit.catalogue_from_map.shift);
    Eigen::Vector4d error;
    error << fit.catalogue_from_map * middle - site.truth * middle,
        std::remainder(fit.catalogue_from_map.yaw - site.truth.yaw, 2 * std::acos(-1.0)),
        fit.catalogue_from_map.log_scale - site.truth.log_scale;
    squares += error.dot(fit.covariance.ldlt().solve(error)) / 4;
  }
  EXPECT_GE(found, 32);
  EXPECT_GT(squares / found, 0.6);  // four unknowns of 32 sites: 128 values, standard deviation 0.125
  EXPECT_LT(squares / found, 1.4);
}

TEST(RegisterCircles, RefusesMapsOfTerrainThatTheCatalogueLacks) {
  for (std::uint64_t seed = 200; seed < 240; ++seed) {
    const Site site = made_site(seed, seed + 1000);
    const CircleRegistration placed = register_circles(site.map, site.catalogue);
    EXPECT_FALSE(placed.fit) << "seed " << seed << ", wrong " << placed.wrong;
    EXPECT_FALSE(placed.message.empty());
  }
}

TEST(RegisterCircles, NamesTwoPlacesOfATwin) {
  Site site = made_site(101, 101);
  const std::size_t count = site.catalogue.size();
  for (std::size_t i = 0; i < count; ++i) {
    Circle twin = site.catalogue[i];
    twin.at.x() += 3 * kSide;
    site.catalogue.push_back(twin);
  }
  const CircleRegistration placed = register_circles(site.map, site.catalogue);
  EXPECT_FALSE(placed.fit);
  EXPECT_NEAR(placed.wrong, 0.5, 0.01);
  EXPECT_THAT(placed.message, HasSubstr("the place is ambiguous: two places explain"));
}

TEST(RegisterCircles, NamesTheNumberOfCratersThatAreTooFew) {
  Site site = made_site(102, 102);
  site.map.resize(3);
  EXPECT_THAT(register_circles(site.map, site.catalogue).message,
              HasSubstr("3 craters of the map and 400 of the catalogue are too few: 4 of each are needed"));
}

TEST(RegisterCircles, DoesNotDependOnTheOrder) {
  Site site = made_site(103, 103);
  const CircleRegistration one = register_circles(site.map, site.catalogue);
  std::ranges::reverse(site.map);
  const CircleRegistration two = register_circles(site.map, site.catalogue);
  ASSERT_TRUE(one.fit && two.fit);
  EXPECT_EQ(one.fit->catalogue_from_map.shift, two.fit->catalogue_from_map.shift);
}

}  // namespace
}  // namespace waymark::test

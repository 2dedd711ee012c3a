// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/error.hpp"
#include "testbed/landing/crater_field.hpp"
#include "testbed/landing/crater_profile.hpp"
#include "testbed/landing/relief.hpp"
#include "testbed/landing/rock_field.hpp"
#include "testbed/noise.hpp"
#include "testbed/scene.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

SiteModel small_site() {
  SiteModel ground;
  ground.width = ground.height = 100;
  ground.craters.max_diameter = 40;
  return ground;
}

SiteModel bare_site() {
  SiteModel ground = small_site();
  ground.relief.rms = 0;
  ground.craters.density = 0;
  ground.craters.clusters = 0;
  ground.rocks.k = 0;
  ground.dunes.cover = 0;
  return ground;
}

TEST(Noise, SlopesAreTheDerivativesOfTheValue) {
  constexpr double kStep = 1e-5;
  Random random(1);
  double squares = 0;
  for (int i = 0; i < 4000; ++i) {
    const double x = random.uniform(-50, 50), y = random.uniform(-50, 50);
    const NoiseValue n = gradient_noise(x, y, 7);
    EXPECT_NEAR(n.dx,
                (gradient_noise_value(x + kStep, y, 7) - gradient_noise_value(x - kStep, y, 7)) / (2 * kStep),
                1e-5);
    EXPECT_NEAR(n.dy,
                (gradient_noise_value(x, y + kStep, 7) - gradient_noise_value(x, y - kStep, 7)) / (2 * kStep),
                1e-5);
    EXPECT_EQ(n.value, gradient_noise_value(x, y, 7));
    squares += n.value * n.value;
  }
  EXPECT_NEAR(std::sqrt(squares / 4000), 1, 0.1);
}

TEST(Fractal, AGridHoldsTheFractal) {
  const Fractal fractal{.longest = 100, .shortest = 1.5, .amplitude = 1, .hurst = 0.8, .seed = 3};
  const NodeGrid nodes{91, 77, -20, 30, 0.7};
  const Grid<float> grid = fractal_grid(fractal, nodes);
  for (std::int64_t j = 0; j < nodes.rows; ++j)
    for (std::int64_t i = 0; i < nodes.columns; ++i)
      ASSERT_NEAR(double(grid(i, j)), fractal.at(nodes.x(i), nodes.y(j)).value, 0.02) << i << ' ' << j;
}

TEST(CraterProfiles, WearDownFromTheFreshBowl) {
  const CraterProfiles& profiles = CraterProfiles::instance();
  EXPECT_NEAR(profiles.depth(0), 0.2, 0.002);
  double before = 1;
  for (double age = 0; age < 0.4; age += 0.004) {
    EXPECT_LT(profiles.depth(age), before) << age;
    before = profiles.depth(age);
    // The crest stays at half a diameter, and stands above the plain.
    for (double r = 0; r < 2.4; r += 0.01)
      EXPECT_LE(profiles.height(age, r), profiles.height(age, 0.5) + 0.003) << age << ' ' << r;
    EXPECT_GT(profiles.height(age, 0.5), 0) << age;
  }
  for (const double depth : {0.19, 0.12, 0.06, 0.03})
    EXPECT_NEAR(profiles.depth(profiles.age(depth)), depth, 0.002);
}

TEST(Craters, TheDugCraterIsTheOneAskedFor) {
  const SiteModel ground = bare_site();
  const NodeGrid nodes = nodes_of(ground);
  Grid<float> heights(nodes.columns, nodes.rows, 3.0F);
  const CraterPlan plan{
      .east = 4, .north = -6, .major = 33, .minor = 27, .turn = 0.5, .age = 0, .infill = 0, .seed = 1};
  excavate(heights, nodes, plan);
  const auto crater = measure_crater(Terrain(heights, nodes.x0, nodes.y0, nodes.step, nodes.step), plan);
  ASSERT_TRUE(crater);
  const double d = std::sqrt(33 * 27);
  EXPECT_NEAR(crater->depth, 0.2 * d, 0.015 * d);
  EXPECT_NEAR(crater->preserved_fraction(), 1, 0.08);
  EXPECT_NEAR(crater->position.z(), 3 + 0.036 * d, 0.01 * d);
  EXPECT_NEAR(crater->orientation, std::numbers::pi / 2 - 0.5, 1e-9);  // clockwise from north
}

TEST(Craters, FollowTheirSizeLaw) {
  SiteModel ground = small_site();
  ground.width = ground.height = 3000;
  ground.craters = {.density = 0.5, .slope = 2, .min_diameter = 8, .max_diameter = 200, .clusters = 0};
  std::size_t above_10 = 0, above_20 = 0, above_40 = 0;
  for (const CraterPlan& plan : draw_craters(ground, 3)) {
    if (std::abs(plan.east) > 1500 || std::abs(plan.north) > 1500) continue;
    above_10 += plan.diameter() > 10, above_20 += plan.diameter() > 20, above_40 += plan.diameter() > 40;
  }
  const auto expected = [](double d) { return 0.5 * 0.08 * 9e6 * (1 / (d * d) - 1 / (200.0 * 200)); };
  // Three standard deviations of a Poisson number.
  EXPECT_NEAR(double(above_10), expected(10), 3 * std::sqrt(expected(10)));
  EXPECT_NEAR(double(above_20), expected(20), 3 * std::sqrt(expected(20)));
  EXPECT_NEAR(double(above_40), expected(40), 3 * std::sqrt(expected(40)));
}

TEST(Rocks, HaveTheOutlineAndHeightOfTheTruthList) {
  for (const RockShape shape : {RockShape::ellipsoid, RockShape::irregular, RockShape::cylinder})
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      Random random(seed);
      const RockSolid rock = make_rock(shape, 2, 1.1, random);
      constexpr int kSteps = 200;
      double area = 0, top = 0;
      for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
          const double x = (i + 0.5) / kSteps * 4 - 2, y = (j + 0.5) / kSteps * 4 - 2;
          if (const auto hit = intersect(rock, {x, y, 5}, {0, 0, -1})) top = std::max(top, 5 - hit->t);
          // At ground level: a point is inside if rays both ways pass through the rock.
          const Eigen::Vector3d at(x, y, 0);
          if (intersects(rock, at, {0, 0, 1}) && intersects(rock, at, {0, 0, -1}))
            area += 16.0 / (kSteps * kSteps);
        }
      const auto label = ::testing::Message() << int(shape) << " seed " << seed;
      EXPECT_NEAR(area, std::numbers::pi, 0.06) << label;
      EXPECT_NEAR(top, 1.1, 0.025) << label;
    }
}

TEST(Rocks, ARayMeetsWhatBlocksIt) {
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    Random own(static_cast<std::uint64_t>(i));
    const RockSolid rock = make_rock(static_cast<RockShape>(i % 3), 2, 1, own);
    const Eigen::Vector3d from(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(2, 6));
    const Eigen::Vector3d along =
        (Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 1)) - from)
            .normalized();
    const auto hit = intersect(rock, from, along);
    EXPECT_EQ(hit.has_value(), intersects(rock, from, along)) << i;
    if (!hit) continue;
    EXPECT_LT(hit->normal.dot(along), 1e-9) << i;
    EXPECT_NEAR(hit->normal.norm(), 1, 1e-6) << i;
    EXPECT_LT((from + hit->t * along).norm(), rock.reach + 1e-6) << i;
  }
}

TEST(Rocks, FollowGolombeksLaw) {
  SiteModel ground = bare_site();
  ground.width = ground.height = 200;
  ground.rocks = {.k = 0.05, .min_diameter = 0.4, .max_diameter = 6, .clustering = 0, .on_rims = 0};
  const Scene scene = make_scene(ground, 11);
  double covered = 0, large = 0;
  for (const TrueRock& rock : scene.rocks) {
    const double area = std::numbers::pi * rock.width * rock.width / 4 / (200 * 200);
    covered += area, large += rock.width > 1 ? area : 0;
  }
  const auto law = [](double d) { return 0.05 * std::exp(-(1.79 + 0.152 / 0.05) * d); };
  // Some rocks find no room; and few are large.
  EXPECT_NEAR(covered, law(0.4) - law(6), 0.06 * law(0.4));
  EXPECT_NEAR(large, law(1) - law(6), 0.25 * law(1));
  for (std::size_t i = 1; i < scene.rocks.size(); ++i)
    EXPECT_LE(scene.rocks[i].width, scene.rocks[i - 1].width);
}

TEST(Outcrops, StandAboveTheGroundAndAreBright) {
  SiteModel ground = bare_site();
  ground.width = ground.height = 300;
  const Scene bare = make_scene(ground, 2);
  ground.outcrops = {.cover = 0.2, .height = 3, .longest = 60, .brightness = 0.5};
  const Scene rocky = make_scene(ground, 2);
  double covered = 0;
  for (std::size_t i = 0; i < bare.albedo.cells().size(); ++i) {
    const float rise = rocky.terrain.heights().cells()[i] - bare.terrain.heights().cells()[i];
    ASSERT_GE(rise, 0);
    ASSERT_LE(rise, 3.01F);
    covered += rise > 0 ? 1 : 0;
    if (rise > 0.1F) {
      ASSERT_GT(rocky.albedo.cells()[i], bare.albedo.cells()[i]);
    }
    if (rise == 0) {
      ASSERT_NEAR(rocky.albedo.cells()[i], bare.albedo.cells()[i], 1e-3);  // less than rounding
    }
  }
  EXPECT_NEAR(covered / double(bare.albedo.cells().size()), 0.2, 0.01);
}

TEST(Scene, IsTheSameBitForBitOnOneThread) {
  const Scene many = make_scene(small_site(), 5);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Scene one = make_scene(small_site(), 5);
  EXPECT_EQ(many.terrain.heights(), one.terrain.heights());
  EXPECT_EQ(many.albedo, one.albedo);
  ASSERT_EQ(many.rocks.size(), one.rocks.size());
  for (std::size_t i = 0; i < one.rocks.size(); ++i) EXPECT_EQ(many.rocks[i].position, one.rocks[i].position);
  EXPECT_NE(make_scene(small_site(), 6).terrain.heights(), one.terrain.heights());
}

TEST(Scene, MoreRocksLeaveTheCratersAlone) {
  SiteModel rocky = small_site();
  rocky.rocks.k = 0.2;
  EXPECT_EQ(make_scene(rocky, 5).terrain.heights(), make_scene(small_site(), 5).terrain.heights());
}

TEST(Scene, RefusesSizesThatMakeNoSense) {
  SiteModel ground = small_site();
  ground.cell = 0;
  try {
    make_scene(ground, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_EQ(error.problem(), "ground.cell must be above 0");
  }
  ground.cell = 1e-5;
  EXPECT_THROW(make_scene(ground, 1), Error);
  ground = small_site();
  ground.craters.max_diameter = 1;
  EXPECT_THROW(make_scene(ground, 1), Error);
}

}  // namespace
}  // namespace waymark::test

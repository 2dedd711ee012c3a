// SPDX-License-Identifier: Apache-2.0
#include "geo/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geo/distortion_limit.hpp"
#include "geo/sun.hpp"

namespace waymark::test {
namespace {

Camera camera(const std::array<double, 8>& distortion, Camera::Lens lens = Camera::Lens::brown) {
  return {.columns = 1000,
          .rows = 800,
          .fx = 900,
          .fy = 910,
          .cx = 510,
          .cy = 395,
          .skew = 0.7,
          .lens = lens,
          .distortion = distortion};
}

// Uniform numbers from a fixed seed; std's distributions differ between libraries, its engines do not.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : bits_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_()) / 4294967295.0;
  }

 private:
  std::mt19937 bits_;
};

// The slow twin: the formulas of OpenCV's documentation, term by term.
Eigen::Vector2d opencv_formula(const Camera& c, const Eigen::Vector3d& p) {
  const auto& k = c.distortion;
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  double xd, yd;
  if (c.lens == Camera::Lens::brown) {
    const double radial = (1 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2) /
                          (1 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2 * r2 * r2);
    xd = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
    yd = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
  } else {
    const double r = std::sqrt(r2), t = std::atan(r);
    const double td = t * (1 + k[0] * std::pow(t, 2) + k[1] * std::pow(t, 4) + k[2] * std::pow(t, 6) +
                           k[3] * std::pow(t, 8));
    xd = r > 0 ? x * td / r : 0;
    yd = r > 0 ? y * td / r : 0;
  }
  return {c.fx * xd + c.skew * yd + c.cx, c.fy * yd + c.cy};
}

TEST(Camera, LooksAlongZWithXRightAndYDown) {
  const Camera pinhole = camera({});
  EXPECT_EQ(*project(pinhole, {Eigen::Vector3d(0, 0, 5)}), Eigen::Vector2d(510, 395));
  EXPECT_GT(project(pinhole, {Eigen::Vector3d(1, 0, 5)})->x(), 510);
  EXPECT_GT(project(pinhole, {Eigen::Vector3d(0, 1, 5)})->y(), 395);
}

TEST(Camera, ProjectsNothingBehindOrBesideIt) {
  for (const auto lens : {Camera::Lens::brown, Camera::Lens::fisheye})
    for (const double z : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
      EXPECT_FALSE(project(camera({0.1}, lens), {Eigen::Vector3d(0.1, 0.2, z)}));
}

TEST(Camera, AgreesWithTheFormulasOfOpenCv) {
  Uniform uniform(1);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool fish = i % 3 == 0;
    std::array<double, 8> k{};
    for (std::size_t n = 0; n < (fish ? 4U : 8U); ++n)
      k[n] = uniform(-0.1, 0.1) * (n == 2 || n == 3 ? 0.1 : 1);
    const Camera c = camera(k, fish ? Camera::Lens::fisheye : Camera::Lens::brown);
    const Eigen::Vector3d p(uniform(-1, 1), uniform(-1, 1), 1.5);
    const auto seen = project(c, {p});
    if (!seen) continue;
    ++compared;
    EXPECT_LT((*seen - opencv_formula(c, p)).norm(), 1e-9);
  }
  EXPECT_GT(compared, 1900);
}

TEST(Camera, GoesThereAndBackThroughWildLenses) {
  Uniform uniform(2);
  int inverted = 0;
  for (int lens = 0; lens < 400; ++lens) {
    std::array<double, 8> k{};
    const bool fish = lens % 4 == 0;
    for (std::size_t n = 0; n < (fish ? 4U : 8U); ++n)
      k[n] = uniform(-0.6, 0.6) * (n == 2 || n == 3 ? 0.03 : 1);
    const Camera c = camera(k, fish ? Camera::Lens::fisheye : Camera::Lens::brown);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d pixel(uniform(-100, 1100), uniform(-100, 900));
      const auto along = ray(c, pixel);
      if (!along) continue;
      ++inverted;
      EXPECT_NEAR(along->unit.norm(), 1, 1e-12);
      const auto again = project(c, {along->unit * uniform(0.1, 1000)});
      ASSERT_TRUE(again) << "lens " << lens;
      EXPECT_LT((*again - pixel).norm(), 1e-6) << "lens " << lens;
    }
  }
  EXPECT_GT(inverted, 10000);
}

TEST(Camera, FindsTheRayOfEveryProjectedPoint) {
  Uniform uniform(3);
  for (int lens = 0; lens < 300; ++lens) {
    std::array<double, 8> k{};
    const bool fish = lens % 4 == 0;
    for (std::size_t n = 0; n < (fish ? 4U : 8U); ++n)
      k[n] = uniform(-0.3, 0.3) * (n == 2 || n == 3 ? 0.005 : 1);
    const Camera c = camera(k, fish ? Camera::Lens::fisheye : Camera::Lens::brown);
    const double field = std::min(distortion_limit(c), fish ? 1.4 : 3.0);
    for (int i = 0; i < 40; ++i) {
      const double r = 0.9 * uniform(0, 1) * field, turn = uniform(0, 6.28);
      const double slope = fish ? std::tan(r) : r;
      const Eigen::Vector3d there =
          Eigen::Vector3d(slope * std::cos(turn), slope * std::sin(turn), 1).normalized();
      const auto seen = project(c, {there});
      if (!seen) continue;
      const auto back = ray(c, *seen);
      ASSERT_TRUE(back) << "lens " << lens << " at " << r << " of " << field;
      EXPECT_LT((back->unit - there).norm(), 1e-6) << "lens " << lens;
    }
  }
}

// With k1 < 0 the image radius r (1 + k1 r^2) has its largest value at r = 1 / sqrt(-3 k1); points
// beyond it would fold back into the image.
TEST(Camera, FarPointsDoNotFoldBackIntoTheImage) {
  const Camera barrel = camera({-0.3});
  const double field = 1 / std::sqrt(0.9);
  EXPECT_NEAR(distortion_limit(barrel), field, 1e-12);
  EXPECT_TRUE(project(barrel, {Eigen::Vector3d(0.99 * field, 0, 1)}));
  EXPECT_FALSE(project(barrel, {Eigen::Vector3d(1.01 * field, 0, 1)}));
  EXPECT_FALSE(
      project(barrel, {Eigen::Vector3d(1.7, 0, 1)}));   // 1.7 (1 - 0.3 1.7^2) = 0.23: inside by formula
  EXPECT_FALSE(ray(barrel, {510 + 900 * field, 395}));  // more than the largest image radius
}

TEST(Camera, LimitIsTheFirstTurningPointByScanning) {
  Uniform uniform(4);
  for (int lens = 0; lens < 200; ++lens) {
    std::array<double, 8> k{};
    for (const std::size_t n : {0U, 1U, 4U, 5U, 6U, 7U}) k[n] = uniform(-1, 1);
    const auto radius = [&](double r) {
      const double s = r * r;
      return r * (1 + s * (k[0] + s * (k[1] + s * k[4]))) / (1 + s * (k[5] + s * (k[6] + s * k[7])));
    };
    const double field = distortion_limit(camera(k));
    const double step = 1e-4, end = std::min(field, 3.0);
    for (double r = step; r < end - step; r += step)
      ASSERT_GT(radius(r), radius(r - step)) << "lens " << lens << " at " << r << " of " << field;
    if (field < 3) {
      const double under = 1 + field * field * (k[5] + field * field * (k[6] + field * field * k[7]));
      EXPECT_TRUE(std::abs(under) < 1e-6 || radius(field + 1e-3) < radius(field) + 1e-6) << "lens " << lens;
    }
  }
}

TEST(DistortionLimit, FindsTheFirstOfManyRoots) {
  // (s - 1)(s - 2)(s - 3)
  EXPECT_NEAR(first_positive_root({-6, 11, -6, 1}), 1, 1e-12);
  EXPECT_EQ(first_positive_root({1, 0, 1}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(first_positive_root({1}), std::numeric_limits<double>::infinity());
}

TEST(Camera, RefusesPixelsThatAreNoNumbers) {
  EXPECT_FALSE(ray(camera({}), {std::nan(""), 0}));
  EXPECT_FALSE(ray(camera({0.1}, Camera::Lens::fisheye), {0, std::numeric_limits<double>::infinity()}));
}

TEST(PosedCamera, PreservesMillimetresAtLargeNorthings) {
  PosedCamera view;
  view.camera = camera({-0.1, 0.02, 1e-3, -1e-3});
  view.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // straight down, north at the top
  view.grid_from_camera.transform.translation() << 500000, 7000000, 150;
  const auto along = ray(view, {100, 700});
  ASSERT_TRUE(along);
  const Point<GridFrame> ground{along->origin.xyz +
                                along->direction.unit * (150 / -along->direction.unit.z())};
  EXPECT_LT(ground.xyz.x(), 500000);   // left of the middle is west
  EXPECT_LT(ground.xyz.y(), 7000000);  // below it is south
  EXPECT_LT((*project(view, ground) - Eigen::Vector2d(100, 700)).norm(), 1e-6);
}

// The slow twin: the ray of each row, and the row nearest to the point among them, by halving.
TEST(PosedCamera, OfARollingShutterAgreesWithItsRays) {
  Uniform uniform(5);
  for (int scene = 0; scene < 200; ++scene) {
    PosedCamera view;
    view.camera = camera({-0.1, 0.02, 1e-3, -1e-3});
    view.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    view.grid_from_camera.transform.translation() << 500000, 7000000, 150;
    view.motion.emplace();
    for (int k = 0; k < 3; ++k) {
      view.motion->shift(k) = uniform(-5, 5);
      view.motion->turn(k) = uniform(-0.03, 0.03);
    }
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d pixel(uniform(0, 999), uniform(0, 799));
      const auto along = ray(view, pixel);
      ASSERT_TRUE(along);
      const Eigen::Vector3d moved = (pixel.y() / 799 - 0.5) * view.motion->shift;
      EXPECT_LT((along->origin.xyz - view.centre().xyz - moved).norm(), 1e-9);
      const Point<GridFrame> ground{along->origin.xyz + along->direction.unit * uniform(50, 300)};
      const auto seen = project(view, ground);
      ASSERT_TRUE(seen);
      EXPECT_LT((*seen - pixel).norm(), 1e-4);
    }
  }
}

TEST(PosedCamera, WithoutMotionIsThatOfAGlobalShutter) {
  PosedCamera still;
  still.camera = camera({-0.1, 0.02});
  still.grid_from_camera.transform.translation() << 1, 2, -50;
  PosedCamera moving = still;
  moving.motion.emplace();
  const Point<GridFrame> point{{10, -7, 3}};
  EXPECT_LT((*project(still, point) - *project(moving, point)).norm(), 1e-9);
  EXPECT_LT((ray(still, {5, 700})->direction.unit - ray(moving, {5, 700})->direction.unit).norm(), 1e-12);
  EXPECT_FALSE(project(moving, {{0, 0, -60}}));  // behind
}

TEST(Sun, ShinesFromItsAzimuthAndElevation) {
  EXPECT_LT((sun_direction({Degrees{90}, Degrees{0}}).unit - Eigen::Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT(
      (sun_direction({Degrees{0}, Degrees{45}}).unit - Eigen::Vector3d(0, std::sqrt(0.5), std::sqrt(0.5)))
          .norm(),
      1e-15);
  EXPECT_NEAR(sun_direction({Degrees{200}, Degrees{30}}).unit.norm(), 1, 1e-15);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/detection_projection.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/random.hpp"
#include "pipeline/fusion/projection/footprint.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
#include "pipeline/fusion/projection/local_ground_plane.hpp"
#include "pipeline/fusion/projection/position_covariance.hpp"
#include "tests/pipeline/fusion/own_types.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Terrain plane(double height, double east = 0, double north = 0, double sd = 0) {
  Grid<float> heights(201, 201);
  for (std::int64_t r = 0; r < 201; ++r)
    for (std::int64_t c = 0; c < 201; ++c)
      heights(c, r) = static_cast<float>(height + east * static_cast<double>(c - 100) * 2 +
                                         north * static_cast<double>(100 - r) * 2);
  return {std::move(heights), -200, 200, 2, 2, sd};
}

// Camera 100 m above the centre, tilted by `tilt` about its x axis, towards north.
ImageView camera(double tilt = 0, double height = 100) {
  ImageView image;
  image.name = "image";
  image.columns = 400, image.rows = 300;
  image.view.emplace();
  Camera& c = image.view->camera;
  c.columns = 400, c.rows = 300, c.fx = c.fy = 500, c.cx = 199.5, c.cy = 149.5;
  Eigen::Matrix3d down;
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // columns: camera x east, y south, z down
  image.view->grid_from_camera.transform.linear() =
      down * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
  image.view->grid_from_camera.transform.translation() = Eigen::Vector3d(0, 0, height);
  return image;
}

Detection at(double x, double y, double diameter = 10) {
  Detection d;
  d.outline = {x, y, diameter, diameter, 0};
  return d;
}

const LandmarkType& kRock = *kTypes.find("rock");
const LandmarkType& kCrater = *kTypes.find("crater");

TEST(Placed, StraightDownIsScale) {
  const Observation o = project_detection(at(249.5, 99.5), camera(), plane(0), kRock, {});
  ASSERT_EQ(o.rejected, "");
  EXPECT_NEAR(o.position.xyz.x(), 10, 1e-4);  // 50 px of 0.2 m
  EXPECT_NEAR(o.position.xyz.y(), 10, 1e-4);
  EXPECT_NEAR(o.features[0].value, 1, 1e-4);  // radius: 5 px
  EXPECT_FALSE(o.features[1].known());        // no shadow, no height
}

TEST(Placed, OrthophotoIsItsGeoreference) {
  ImageView image;
  image.columns = image.rows = 100;
  image.ortho = OrthoGrid{50, 80, 0.5, -0.5};
  const Observation o = project_detection(at(10, 20), image, plane(7), kRock, {});
  ASSERT_EQ(o.rejected, "");
  EXPECT_NEAR((o.position.xyz - Eigen::Vector3d(55, 70, 7)).norm(), 0, 1e-4);
  EXPECT_NEAR(o.covariance(0, 0), 0.25 * 0.25, 1e-6);  // 0.5 px of 0.5 m
}

TEST(Placed, CircleOnTheGroundStaysOneSeenFromTheSide) {
  const ImageView image = camera(30 * kDegree);
  // A circle of radius 4 m on the ground, projected and fitted by an ellipse in the image.
  const GroundPlane ground{{0, 58, 0}, {0, 0}};
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), a = centre, b = centre;
  for (int k = 0; k < 16; ++k) {
    const double t = 2 * std::numbers::pi * k / 16;
    const auto p = project_to_image(image, {{4 * std::cos(t), 58 + 4 * std::sin(t), 0}});
    ASSERT_TRUE(p);
    centre += *p / 16, a += *p * std::cos(t) / 8, b += *p * std::sin(t) / 8;
  }
  Detection d = at(centre.x(), centre.y());
  d.outline.major = 2 * a.norm(), d.outline.minor = 2 * b.norm();
  const auto on = project_outline(image, d.outline, ground);
  ASSERT_TRUE(on);
  EXPECT_NEAR(on->major, 8, 0.1);
  EXPECT_NEAR(on->minor, 8, 0.1);
  EXPECT_NEAR(on->centre.y(), 58, 0.1);
}

TEST(Placed, OrientationIsClockwiseFromNorth) {
  Detection d = at(199.5, 149.5);
  d.outline.major = 20;
  d.outline.angle = 30 * kDegree;  // from east towards south: azimuth 120, as an axis -60
  const Observation o = project_detection(d, camera(), plane(0), kCrater, {});
  EXPECT_NEAR(o.features[feature_index(kCrater, "orientation")].value, -60 * kDegree, 1e-6);
  EXPECT_NEAR(o.features[feature_index(kCrater, "major_axis")].value, 4, 1e-4);
  EXPECT_NEAR(o.features[feature_index(kCrater, "minor_axis")].value, 2, 1e-4);
}

TEST(Placed, ReportsWhyThereIsNoGround) {
  EXPECT_EQ(project_detection(at(199, 149), camera(120 * kDegree), plane(0), kRock, {}).rejected,
            "no ground in its line of sight");
  EXPECT_EQ(project_detection(at(199, 149), camera(0, -50), plane(0), kRock, {}).rejected,
            "camera under the ground");
  Grid<float> heights(11, 11, std::nanf(""));
  heights(0, 0) = heights(1, 0) = heights(0, 1) = heights(1, 1) = 0;
  EXPECT_EQ(project_detection(at(199, 149), camera(), Terrain(heights, -50, 50, 10, 10), kRock, {}).rejected,
            "height of the ground unknown");
}

TEST(Placed, AssumedPlaneGivesNoHeight) {
  const Observation o = project_detection(at(199, 149), camera(), plane(0), kRock, {.heights_known = false});
  EXPECT_TRUE(std::isnan(o.covariance(2, 2)));
  EXPECT_TRUE((o.covariance.topLeftCorner<2, 2>().allFinite()));
}

// Compares the covariance with random errors propagated through the whole projection.
TEST(PlaceCovariance, MatchesDrawing) {
  const double tilt = 35 * kDegree;
  ImageView image = camera(tilt);
  const Eigen::Vector<double, 6> sd =
      (Eigen::Vector<double, 6>() << 2e-3, 3e-3, 1e-3, 0.2, 0.3, 0.4).finished();
  image.view->covariance = sd.cwiseAbs2().asDiagonal();
  Detection d = at(240, 120);
  d.covariance << 0.3, 0.1, 0.1, 0.2;
  const double height_sd = 0.25, east = 0.1, north = -0.05;
  const Terrain given = plane(0, east, north, height_sd);
  const Observation o = project_detection(d, image, given, kRock, {});
  ASSERT_EQ(o.rejected, "");

  Random random(1, "drawing");
  const Eigen::Matrix2d root = d.covariance.llt().matrixL();
  Eigen::Matrix3d drawn = Eigen::Matrix3d::Zero();
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    ImageView moved = image;
    auto& pose = moved.view->grid_from_camera.transform;
    Eigen::Vector<double, 6> e;
    for (int k = 0; k < 6; ++k) e[k] = sd[k] * random.normal();
    const Eigen::Vector3d turn = e.head<3>();
    pose.linear() = pose.linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized());
    pose.translation() += e.tail<3>();
    const Eigen::Vector2d pixel =
        Eigen::Vector2d(d.outline.x, d.outline.y) + root * Eigen::Vector2d(random.normal(), random.normal());
    const GroundPlane ground{{0, 0, height_sd * random.normal()}, {east, north}};
    const auto point = intersect(*viewing_ray(moved, pixel), ground);
    ASSERT_TRUE(point);
    const Eigen::Vector3d error = *point - o.position.xyz;
    drawn += error * error.transpose() / kTrials;
  }
  EXPECT_LT((drawn - o.covariance).norm(), 0.08 * drawn.norm());  // 4000 draws: 2 % of each variance
}

TEST(HeightFromShadow, OnLevelGroundIsTheTangent) {
  ImageView image = camera();
  const Sun sun{Degrees{90}, Degrees{30}, Degrees{0.5}};
  const GroundPlane ground{{0, 0, 0}, {0, 0}};
  const auto h = height_from_shadow({20, 1}, image, ground, sun, 0);  // 4 m of shadow
  ASSERT_TRUE(h);
  EXPECT_NEAR(h->value, 4 * std::tan(30 * kDegree), 1e-3);
  EXPECT_NEAR(h->sd, std::hypot(0.2 * std::tan(30 * kDegree), 4 / 0.75 * 0.5 * kDegree), 2e-3);
}

TEST(HeightFromShadow, DownhillShadowsAreLonger) {
  // Sun in the east, ground falls to the west by 10 degrees: H = L (tan 30 - tan 10).
  const GroundPlane ground{{0, 0, 0}, {std::tan(10 * kDegree), 0}};
  const auto h = height_from_shadow({20, 1}, camera(), ground, {Degrees{90}, Degrees{30}}, 0);
  ASSERT_TRUE(h);
  EXPECT_NEAR(h->value, 4 * (std::tan(30 * kDegree) - std::tan(10 * kDegree)), 0.01);
  // Steeper than the sun: the whole slope is dark.
  const GroundPlane steep{{0, 0, 0}, {std::tan(35 * kDegree), 0}};
  EXPECT_FALSE(height_from_shadow({20, 1}, camera(), steep, {Degrees{90}, Degrees{30}}, 0));
}

TEST(HeightFromShadow, ReachThatRespondsInPartIsCorrectedInPart) {
  const GroundPlane ground{{0, 0, 0}, {std::tan(10 * kDegree), 0}};
  const Sun sun{Degrees{90}, Degrees{30}};
  const auto h = height_from_shadow({20, 1}, camera(), ground, sun, 0, 0.4);
  ASSERT_TRUE(h);
  EXPECT_NEAR(h->value, 4 * (std::tan(30 * kDegree) - 0.4 * std::tan(10 * kDegree)), 0.01);
  const GroundPlane steep{{0, 0, 0}, {std::tan(35 * kDegree), 0}};
  EXPECT_FALSE(height_from_shadow({20, 1}, camera(), steep, sun, 0, 0.4));
}

TEST(Placed, HeightIsCorrectedForTheSlopeAsFarAsTheReachRespondsToIt) {
  ImageView image = camera();
  image.sun = Sun{Degrees{90}, Degrees{30}};
  Detection d = at(199.5, 149.5);
  d.shadow_reach = MeasuredValue{20, 1};
  const auto height = [&](double follows) {
    d.reach_slope_response = follows;
    const double east = std::tan(10 * kDegree);
    return project_detection(d, image, plane(0, east), kRock, {})
        .features[feature_index(kRock, "height")]
        .value;
  };
  EXPECT_NEAR(height(1), 4 * (std::tan(30 * kDegree) - std::tan(10 * kDegree)), 0.01);
  EXPECT_NEAR(height(0.4), 4 * (std::tan(30 * kDegree) - 0.4 * std::tan(10 * kDegree)), 0.01);
}

// Ground that falls away from the sun lengthens shadows, so rocks appear larger and are corrected.
TEST(Placed, WidthIsCorrectedForTheSlopeAsFarAsItResponds) {
  ImageView image = camera();
  image.sun = Sun{Degrees{90}, Degrees{30}};
  Detection d = at(199.5, 149.5);
  d.shadow_reach = MeasuredValue{20, 1};
  const auto radius = [&](double follows, double east) {
    d.diameter_slope_response = follows;
    return project_detection(d, image, plane(0, east), kRock, {})
        .features[feature_index(kRock, "radius")]
        .value;
  };
  const double half = std::tan(30 * kDegree) / 2;
  const auto factor = [&](double east) { return radius(0.2, east) / radius(0, east); };
  EXPECT_NEAR(factor(0), 1, 1e-12);
  EXPECT_NEAR(factor(half), std::pow(0.5, 0.2), 1e-5);  // heights are floats
  EXPECT_NEAR(factor(-half), std::pow(1.5, 0.2), 1e-5);
  EXPECT_NEAR(factor(1.8 * half), std::pow(0.5, 0.2), 1e-5);  // hardly lit: clamped
}

TEST(Footprint, OfACameraStraightDownIsARectangle) {
  const Footprint f = footprint(camera(), plane(0));
  ASSERT_EQ(f.rings.size(), 1u);
  EXPECT_NEAR(f.area, 80 * 60, 1);  // 400 x 300 px of 0.2 m
  EXPECT_NEAR(f.gsd, 0.2, 1e-3);
  EXPECT_EQ(f.rings[0].front(), f.rings[0].back());
  EXPECT_TRUE(inside(f.rings[0], {39, 29}));
  EXPECT_FALSE(inside(f.rings[0], {41, 0}));
}

TEST(Footprint, LeavesOutGroundBehindARidge) {
  Grid<float> heights(201, 201, 0);
  for (std::int64_t c = 0; c < 201; ++c)
    for (std::int64_t r = 60; r < 64; ++r) heights(c, r) = 30;  // a wall about y = 76
  const Terrain terrain(std::move(heights), -200, 200, 2, 2);
  const Footprint open = footprint(camera(40 * kDegree), plane(0));
  const Footprint hidden = footprint(camera(40 * kDegree), terrain);
  const auto shows = [](const Footprint& f, double x, double y) {
    return std::any_of(f.rings.begin(), f.rings.end(), [&](const auto& r) { return inside(r, {x, y}); });
  };
  EXPECT_TRUE(shows(open, 0, 90));
  EXPECT_FALSE(shows(hidden, 0, 90));
  EXPECT_TRUE(shows(hidden, 0, 60));
  EXPECT_LT(hidden.area, open.area);
}

TEST(Footprint, OfTheSkyIsNothing) {
  EXPECT_TRUE(footprint(camera(130 * kDegree), plane(0)).rings.empty());
}

TEST(LatticeRings, RingAreasAddUpAndHaveNoHoles) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, "rings");
    Grid<std::uint8_t> marked(9, 7, 0);
    int count = 0;
    for (auto& cell : marked.cells()) count += cell = random.bernoulli(0.7);
    double area = 0;
    for (const auto& ring : lattice_rings(marked)) {
      ASSERT_EQ(ring.front(), ring.back());
      double twice = 0;
      for (std::size_t i = 0; i + 1 < ring.size(); ++i)
        twice += static_cast<double>(ring[i].column * ring[i + 1].row - ring[i + 1].column * ring[i].row);
      EXPECT_GT(twice, 0) << "seed " << seed;  // clockwise as rows run down
      area += twice / 2;
    }
    EXPECT_EQ(area, count) << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark::test

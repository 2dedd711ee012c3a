// SPDX-License-Identifier: Apache-2.0
#include "geo/outline_shapes.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <random>

#include "core/units.hpp"

namespace waymark::test {
namespace {

using Kind = GeometryPart::Kind;
using testing::DoubleNear;
constexpr double kTurn = std::numbers::pi;

/// A house of 10 m by 4 m whose south-west corner is the origin; vertices from there counter-clockwise.
std::vector<GeometryPart> house() {
  return {{Kind::outline, {{0, 0, 0}, {10, 0, 0}, {10, 4, 0}, {0, 4, 0}}}};
}

const DerivedShape& at(const DerivedShapes& derived, double x, double y, std::size_t nth = 0) {
  for (const DerivedShape& shape : derived.shapes)
    if ((shape.at.head<2>() - Eigen::Vector2d(x, y)).norm() < 1e-9 && nth-- == 0) return shape;
  throw std::logic_error("no shape there");
}

TEST(OutlineShapes, CornersOfAHouseAreConvexAndLookOutwards) {
  const DerivedShapes derived = derive_shapes(house(), {.shape = ShapeOf::corners});
  ASSERT_EQ(derived.shapes.size(), 4U);
  EXPECT_NEAR(at(derived, 10, 4).values.at("direction"), kTurn / 4, 1e-12);        // north-east
  EXPECT_NEAR(at(derived, 0, 0).values.at("direction"), -3 * kTurn / 4, 1e-12);    // south-west
  EXPECT_NEAR(at(derived, 10, 0).values.at("opening_angle"), 1.5 * kTurn, 1e-12);  // three quarters are open
}

TEST(OutlineShapes, CornersOfARoomAreConcaveAndLookInwards) {
  const DerivedShapes derived = derive_shapes(house(), {.shape = ShapeOf::corners, .open = OpenSide::inside});
  EXPECT_NEAR(at(derived, 10, 4).values.at("direction"), -3 * kTurn / 4, 1e-12);
  EXPECT_NEAR(at(derived, 10, 4).values.at("opening_angle"), kTurn / 2, 1e-12);
}

TEST(OutlineShapes, ACourtyardIsOutside) {
  auto parts = house();
  parts.push_back({Kind::hole, {{4, 1, 0}, {6, 1, 0}, {6, 3, 0}, {4, 3, 0}}});  // any orientation
  const DerivedShapes derived = derive_shapes(parts, {.shape = ShapeOf::corners});
  ASSERT_EQ(derived.shapes.size(), 8U);
  EXPECT_NEAR(at(derived, 6, 3).values.at("direction"), -3 * kTurn / 4, 1e-12);  // into the courtyard
  EXPECT_NEAR(at(derived, 6, 3).values.at("opening_angle"), kTurn / 2, 1e-12);
}

TEST(OutlineShapes, WallsFaceOutwardsAndAreCertainAcrossOnly) {
  const DerivedShapes derived = derive_shapes(house(), {.shape = ShapeOf::walls, .max_length = 5});
  ASSERT_EQ(derived.shapes.size(), 6U);  // the long walls are cut in two
  const DerivedShape& south = at(derived, 2.5, 0);
  EXPECT_NEAR(std::abs(south.values.at("direction")), kTurn, 1e-12);
  EXPECT_NEAR(south.values.at("length"), 5, 1e-12);
  EXPECT_NEAR(south.along_sd, 5 / std::sqrt(12.0), 1e-12);
  EXPECT_NEAR(std::abs(south.along.x()), 1, 1e-12);
  EXPECT_NEAR(at(derived, 10, 2).values.at("direction"), kTurn / 2, 1e-12);
}

TEST(OutlineShapes, BothEndsOfALineHaveTwoFaces) {
  const std::vector<GeometryPart> wall = {{Kind::line, {{0, 0, 0}, {5, 0, 0}}}};
  const DerivedShapes derived = derive_shapes(wall, {.shape = ShapeOf::ends});
  ASSERT_EQ(derived.shapes.size(), 4U);
  // From the north one looks south and has the wall, west of its east end, on the right.
  const DerivedShape& first = at(derived, 5, 0, 0);
  const DerivedShape& north = std::abs(first.values.at("direction")) < 1e-9 ? first : at(derived, 5, 0, 1);
  EXPECT_NEAR(north.values.at("direction"), 0, 1e-12);
  EXPECT_EQ(north.values.at("side"), -1);
}

TEST(OutlineShapes, ALineThatEndsWhereItBeginsHasACornerThereAndNoEnds) {
  const std::vector<GeometryPart> room = {
      {Kind::line, {{0, 0, 0}, {10, 0, 0}, {10, 4, 0}, {0, 4, 0}, {0, 0, 0}}}};
  const DerivedShapes corners = derive_shapes(room, {.shape = ShapeOf::corners});
  ASSERT_EQ(corners.shapes.size(), 8U);  // each from inside and outside
  for (const std::size_t nth : {0U, 1U}) {
    const auto& seen = at(corners, 0, 0, nth).values;
    const bool inside = seen.at("opening_angle") < kTurn;
    EXPECT_NEAR(seen.at("opening_angle"), (inside ? 0.5 : 1.5) * kTurn, 1e-12);
    EXPECT_NEAR(seen.at("direction"), inside ? kTurn / 4 : -3 * kTurn / 4, 1e-12);
  }
  EXPECT_TRUE(derive_shapes(room, {.shape = ShapeOf::ends}).shapes.empty());
  const DerivedShapes walls = derive_shapes(room, {.shape = ShapeOf::walls});
  EXPECT_EQ(walls.shapes.size(), 8U);
  EXPECT_TRUE(walls.omitted.empty());
  const DerivedShapes area = derive_shapes(room, {.shape = ShapeOf::outline});
  ASSERT_EQ(area.shapes.size(), 1U);
  EXPECT_NEAR(area.shapes[0].values.at("area"), 40, 1e-12);
}

TEST(OutlineShapes, LinesThatMeetAreACornerAndNoEnds) {
  std::vector<std::vector<SharedVertex>> joined = {
      {{}, {.corner = false, .wall = false, .joined = true, .next = Eigen::Vector2d(5, 3)}}};
  const std::vector<GeometryPart> wall = {{Kind::line, {{0, 0, 0}, {5, 0, 0}}}};
  const DerivedShapes ends = derive_shapes(wall, {.shape = ShapeOf::ends}, joined);
  ASSERT_EQ(ends.shapes.size(), 2U);
  EXPECT_EQ(ends.shapes[0].at.x(), 0);
  const DerivedShapes corner = derive_shapes(wall, {.shape = ShapeOf::corners}, joined);
  ASSERT_EQ(corner.shapes.size(), 2U);
  // The wall comes from the west and goes on to the north: the open quarter is north-west.
  const DerivedShape& first = corner.shapes[0];
  const DerivedShape& quarter = first.values.at("opening_angle") < kTurn ? first : corner.shapes[1];
  EXPECT_NEAR(quarter.values.at("opening_angle"), kTurn / 2, 1e-12);
  EXPECT_NEAR(quarter.values.at("direction"), -kTurn / 4, 1e-12);
  joined[0][1].next = Eigen::Vector2d(9, 0);  // straight on
  EXPECT_TRUE(derive_shapes(wall, {.shape = ShapeOf::corners}, joined).shapes.empty());
}

TEST(OutlineShapes, CentroidOfAnOutlineHasAreaDiameterAndOrientation) {
  auto parts = house();
  const DerivedShapes whole = derive_shapes(parts, {.shape = ShapeOf::centroid});
  ASSERT_EQ(whole.shapes.size(), 1U);
  EXPECT_NEAR((whole.shapes[0].at - Eigen::Vector3d(5, 2, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(whole.shapes[0].values.at("area"), 40, 1e-9);
  EXPECT_NEAR(std::abs(whole.shapes[0].values.at("orientation")), kTurn / 2, 1e-9);  // east-west
  parts.push_back({Kind::hole, {{0.5, 1, 0}, {4.5, 1, 0}, {4.5, 3, 0}, {0.5, 3, 0}}});
  const DerivedShapes rest = derive_shapes(parts, {.shape = ShapeOf::centroid});
  EXPECT_NEAR(rest.shapes[0].values.at("area"), 32, 1e-9);
  EXPECT_NEAR(rest.shapes[0].at.x(), (40 * 5 - 8 * 2.5) / 32, 1e-9);
}

TEST(OutlineShapes, BrokenGeometryIsCountedByReason) {
  const std::vector<GeometryPart> spike = {{Kind::outline, {{0, 0, 0}, {9, 0, 0}, {9, 0, 0}, {9, 9, 0}}}};
  EXPECT_EQ(derive_shapes(spike, {.shape = ShapeOf::walls}).omitted.at("wall of zero length"), 1);
  EXPECT_EQ(derive_shapes(spike, {.shape = ShapeOf::walls}).shapes.size(), 3U);
  const std::vector<GeometryPart> flat = {{Kind::outline, {{0, 0, 0}, {9, 0, 0}}}};
  EXPECT_EQ(derive_shapes(flat, {.shape = ShapeOf::centroid}).omitted.at("outline without area"), 1);
  const std::vector<GeometryPart> dot = {{Kind::line, {{1, 1, 0}, {1, 1, 0}}}};
  EXPECT_EQ(derive_shapes(dot, {.shape = ShapeOf::ends}).omitted.at("line of zero length"), 1);
  EXPECT_EQ(derive_shapes({}, {}).omitted.at("no geometry"), 1);
  EXPECT_EQ(derive_shapes(flat, {.shape = ShapeOf::point}).omitted.at("no point"), 1);
}

// Turning and mirroring an outline turns its corners; the order of its vertices does not matter.
TEST(OutlineShapes, CornersTurnWithTheOutline) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> radius(5, 15), any(-3, 3);
  for (int trial = 0; trial < 50; ++trial) {
    GeometryPart star{Kind::outline, {}};
    for (int k = 0; k < 9; ++k) {
      const double angle = k * 2 * kTurn / 9, r = radius(random);
      star.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    const double turn = any(random);
    GeometryPart turned = star;
    std::ranges::reverse(turned.vertices);
    for (auto& v : turned.vertices)
      v = Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitZ()) * v + Eigen::Vector3d(100, -50, 0);
    const ShapeOptions options{.shape = ShapeOf::corners, .min_turn = 1e-3};
    const DerivedShapes before = derive_shapes({star}, options), after = derive_shapes({turned}, options);
    ASSERT_EQ(before.shapes.size(), after.shapes.size()) << trial;
    for (const DerivedShape& shape : before.shapes) {
      const Eigen::Vector3d to =
          Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitZ()) * shape.at + Eigen::Vector3d(100, -50, 0);
      const auto twin =
          std::ranges::find_if(after.shapes, [&](auto& s) { return (s.at - to).norm() < 1e-6; });
      ASSERT_NE(twin, after.shapes.end());
      EXPECT_NEAR(twin->values.at("opening_angle"), shape.values.at("opening_angle"), 1e-9);
      EXPECT_NEAR(
          std::remainder(twin->values.at("direction") - shape.values.at("direction") - turn, 2 * kTurn), 0,
          1e-9);
    }
  }
}

TEST(OutlineShapes, SharedWallsAndCornersAreLeftOut) {
  std::vector<std::vector<SharedVertex>> shared = {{{}, {true, true}, {true, false}, {}}};  // the east wall
  const auto walls = derive_shapes(house(), {.shape = ShapeOf::walls}, shared);
  EXPECT_EQ(walls.omitted.at("wall shared with another outline"), 1);
  EXPECT_THROW(at(walls, 10, 2), std::logic_error);
  auto reversed = house();
  std::ranges::reverse(reversed[0].vertices);        // (0,4) (10,4) (10,0) (0,0)
  shared = {{{}, {true, true}, {true, false}, {}}};  // its second wall is the same
  EXPECT_THROW(at(derive_shapes(reversed, {.shape = ShapeOf::walls}, shared), 10, 2), std::logic_error);
  EXPECT_EQ(derive_shapes(house(), {.shape = ShapeOf::corners}, shared).shapes.size(), 2U);
}

}  // namespace
}  // namespace waymark::test

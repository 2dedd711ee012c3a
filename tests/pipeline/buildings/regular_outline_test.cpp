// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/regular_outline.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "pipeline/forest/crowns.hpp"
#include "tests/pipeline/buildings/town_score.hpp"

namespace waymark::test {
namespace {

/// Returns a shape on cells of a side: those whose centres it contains.
RoofOutline on_cells(const std::function<bool(const Eigen::Vector2d&)>& contains, double side, double reach) {
  const auto n = static_cast<std::int64_t>(2 * reach / side);
  Grid<std::uint8_t> in(n, n, 0);
  const auto at = [&](double c, double r) { return Eigen::Vector2d(c * side - reach, reach - r * side); };
  for (std::int64_t r = 0; r < n; ++r)
    for (std::int64_t c = 0; c < n; ++c) in(c, r) = contains(at(double(c) + 0.5, double(r) + 0.5));
  const Outline outline = outline_of(in, 0, 0);
  RoofOutline roof{.cell = side, .spacing = side};
  for (const CanopyCell& corner : outline.ring)
    roof.outer.push_back(at(double(corner.column), double(corner.row)));
  roof.area = double(outline.cells) * side * side;
  return roof;
}

double farthest_corner(const std::vector<Eigen::Vector2d>& truth, const std::vector<Eigen::Vector2d>& found) {
  double worst = 0;
  for (const Eigen::Vector2d& corner : truth) {
    double nearest = 1e9;
    for (const Eigen::Vector2d& v : found) nearest = std::min(nearest, (v - corner).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(Regularise, TurnedHousesGetTheirCornersBack) {
  Random random(3, "houses");
  for (int trial = 0; trial < 60; ++trial) {
    const double turn = random.uniform(0, std::numbers::pi);
    const House house = trial % 2 ? rectangle({0, 0}, turn, 14, 8, Roof::flat, 5, 0)
                                  : angle({0, 0}, turn, 14, 6, 7, true, 5, 0);
    const RoofOutline roof = on_cells([&](const Eigen::Vector2d& p) { return house.z(p) > 0; }, 0.25, 20);
    const RegularOutline outline = regularise(roof);
    ASSERT_EQ(outline.kind, OutlineKind::regular) << trial;
    EXPECT_EQ(outline.outer.vertices.size(), house.corners.size()) << trial << " turned by " << turn;
    EXPECT_LT(farthest_corner(house.outline(), outline.outer.vertices), 0.25) << trial;
    const double off = std::remainder(outline.direction - turn, std::numbers::pi / 2);
    EXPECT_LT(std::abs(off), 0.03) << trial;  // a cell over 8 m
  }
}

TEST(Regularise, WallsMeetAtRightAngles) {
  const House house = angle({0, 0}, 0.3, 14, 6, 7, true, 5, 0);
  const auto ring =
      regularise(on_cells([&](const Eigen::Vector2d& p) { return house.z(p) > 0; }, 0.25, 20)).outer.vertices;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = (ring[(i + 1) % ring.size()] - ring[i]).normalized(),
                          b = (ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()]).normalized();
    EXPECT_NEAR(a.dot(b), 0, 1e-9);
  }
}

TEST(Regularise, AWallOfAnotherDirectionKeepsIt) {
  // A rectangle with a corner cut off over 6 m.
  const auto in = [](const Eigen::Vector2d& p) {
    return std::abs(p.x()) < 8 && std::abs(p.y()) < 6 && p.x() + p.y() < 8;
  };
  const RegularOutline outline = regularise(on_cells(in, 0.25, 16));
  const std::vector<Eigen::Vector2d> truth{{-8, -6}, {8, -6}, {8, 0}, {2, 6}, {-8, 6}};
  EXPECT_EQ(outline.outer.vertices.size(), truth.size());
  EXPECT_LT(farthest_corner(truth, outline.outer.vertices), 0.4);
}

TEST(Regularise, NoOutlineIntersectsItself) {
  Random random(11, "blobs");
  int regular = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::pair<Eigen::Vector2d, double>> discs;
    Eigen::Vector2d at(0, 0);
    for (int i = 0; i < 8; ++i) {
      const double radius = random.uniform(0.8, 4);
      discs.emplace_back(at, radius);
      const double azimuth = random.uniform(0, 2 * std::numbers::pi);
      at += 0.8 * radius * Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth));
    }
    const auto in = [&](const Eigen::Vector2d& p) {
      return std::ranges::any_of(discs, [&](const auto& d) { return (p - d.first).norm() < d.second; });
    };
    const RoofOutline roof = on_cells(in, 0.5, 30);
    const RegularOutline outline = regularise(roof);
    ASSERT_TRUE(is_simple(outline.outer.vertices)) << trial;
    EXPECT_GT(ring_area(outline.outer.vertices), 0) << trial;
    EXPECT_NEAR(ring_area(outline.outer.vertices), roof.area, 0.25 * roof.area) << trial;
    EXPECT_EQ(outline.outer.sd.size(), outline.outer.vertices.size());
    regular += outline.kind == OutlineKind::regular;
  }
  EXPECT_GT(regular, 150);  // blobs without a straight wall: what cannot be fitted keeps its cells
}

TEST(IsSimple, SeesCrossingsAndFolds) {
  EXPECT_TRUE(is_simple({{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {1, 0}, {1, 2}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 0}, {0, 2}}));
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/line_pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "landmarks/landmark_type.hpp"

namespace waymark::test {
namespace {

using workflows::unite_lines;

/// Pieces of walls as observations; `azimuth` is that of the normal.
class Walls {
 public:
  Walls() { register_landmark_types(types_); }

  Observation piece(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const Eigen::Vector2d along = (to - from).normalized();
    Observation o;
    o.type = types_.id("wall");
    o.position.xyz << (from + to) / 2, 0;
    o.features.resize(types_[o.type].features.size());
    o.features[feature_index(types_[o.type], "direction")] = {std::atan2(along.y(), -along.x()), 1e-4, 1};
    o.features[feature_index(types_[o.type], "length")] = {(to - from).norm(), 0.25, 1};
    return o;
  }
  double length(const Observation& o) const {
    return o.features[feature_index(types_[o.type], "length")].value;
  }
  const TypeRegistry& types() const { return types_; }

 private:
  TypeRegistry types_;
};

TEST(LinePieces, OfOneWallAreOneLineInAnyOrder) {
  const Walls walls;
  const Eigen::Vector2d start(3, -7), along(std::cos(0.4), std::sin(0.4));
  std::vector<Observation> pieces;
  // 0 to 5, 8 to 10 and 14 to 20 are joined only by the piece from 4.5 to 13.
  for (const auto& [from, to] : {std::pair{0.0, 5.0}, {8.0, 10.0}, {14.0, 20.0}, {4.5, 13.0}, {0.5, 2.0}})
    pieces.push_back(walls.piece(start + from * along, start + to * along));
  std::mt19937 random(3);
  for (int order = 0; order < 60; ++order) {
    std::vector<Observation> united = pieces;
    std::ranges::shuffle(united, random);
    unite_lines(united, walls.types());
    for (const Observation& o : united) {
      EXPECT_NEAR(walls.length(o), 20, 1e-9);
      EXPECT_NEAR((o.position.xyz.head<2>() - (start + 10 * along)).norm(), 0, 1e-9);
    }
  }
}

TEST(LinePieces, OfDifferentWallsStayApart) {
  const Walls walls;
  std::vector<Observation> united{walls.piece({0, 0}, {6, 0}), walls.piece({0, 1}, {6, 1}),  // beside it
                                  walls.piece({10, 0}, {12, 0}),                             // a gap of 4 m
                                  walls.piece({6, 0}, {6, 5}),
                                  walls.piece({6, 0}, {0, 0})};  // across, other face
  const std::vector<Observation> before = united;
  unite_lines(united, walls.types());
  for (std::size_t i = 0; i < united.size(); ++i) {
    EXPECT_NEAR(walls.length(united[i]), walls.length(before[i]), 1e-9) << i;
    EXPECT_NEAR((united[i].position.xyz - before[i].position.xyz).norm(), 0, 1e-9) << i;
  }
}

TEST(LinePieces, ObservationsOfPointsStay) {
  const Walls walls;
  Observation pole;
  pole.type = walls.types().id("pole");
  pole.position.xyz << 1, 0, 0;
  pole.features.resize(walls.types()[pole.type].features.size());
  std::vector<Observation> all{walls.piece({0, 0}, {2, 0}), pole, walls.piece({2.5, 0}, {5, 0})};
  unite_lines(all, walls.types());
  EXPECT_EQ(all[1].position.xyz.x(), 1);
  EXPECT_NEAR(walls.length(all[0]), 5, 1e-9);
  EXPECT_EQ(walls.length(all[0]), walls.length(all[2]));
}

// A look sees a wall on both sides of a door; others see all of it, its leaf, and a shelf 0.3 m before it.
TEST(LinePieces, OfOneLookAreOneObservationAndDeviationsAreStated) {
  const Walls walls;
  std::vector<Observation> all{walls.piece({0, 0}, {4, 0}), walls.piece({5, 0.02}, {9, 0.02}),
                               walls.piece({0, 0}, {9, 0}), walls.piece({4, -0.05}, {5, -0.08}),
                               walls.piece({2, 0.3}, {4, 0.3})};
  const char* sources[] = {"a", "a", "b", "c", "d"};
  const std::size_t direction = feature_index(walls.types()[all[0].type], "direction");
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].source = sources[i];
    all[i].covariance.setZero();
    all[i].covariance(1, 1) = i == 4 ? 1e-2 : 1e-4;
    all[i].features[direction].variance = 1e-4 / walls.length(all[i]);
  }
  const double shelf_turn = all[4].features[direction].variance;
  unite_lines(all, walls.types());
  ASSERT_EQ(all.size(), 4u);
  EXPECT_NEAR(all[0].position.xyz.y(), 0.01, 0.02);  // between both pieces
  EXPECT_LT(all[0].covariance(1, 1), 5e-4);
  const Observation &leaf = all[2], &shelf = all[3];
  EXPECT_EQ(leaf.source, "c");
  EXPECT_GT(leaf.covariance(1, 1), 0.002);
  EXPECT_GT(leaf.features[direction].variance, 5e-4);
  EXPECT_EQ(shelf.source, "d");
  EXPECT_NEAR(shelf.covariance(1, 1), 1e-2, 1e-9) << "another line, so no deviation of this one";
  EXPECT_EQ(shelf.features[direction].variance, shelf_turn);
}

TEST(LinePieces, AMergedLineIsUnknownAlongItself) {
  const Walls walls;
  const Observation one = walls.piece({0, 0}, {12, 0});
  Landmark wall;
  wall.type = one.type;
  wall.features = one.features;
  wall.covariance.setZero();
  workflows::widen_line(wall, walls.types()[wall.type]);
  EXPECT_NEAR(wall.covariance(0, 0), 12, 1e-9);  // 12 squared / 12
  EXPECT_NEAR(wall.covariance(1, 1), 0, 1e-9);
}

}  // namespace
}  // namespace waymark::test

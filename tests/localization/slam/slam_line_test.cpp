// SPDX-License-Identifier: Apache-2.0
// Walls in SLAM: lines of two unknowns, in pieces that are one landmark.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numbers>

#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/graph_solver.hpp"
#include "localization/slam/pose_graph_builder.hpp"
#include "tests/localization/made_types.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
namespace {

/// A piece of wall that is seen from its left. It deviates from the line of its wall.
struct MadePiece {
  Eigen::Vector2d from, to;
  double offset = 0, turn = 0;  ///< m towards the sensor at its middle, rad to the left
};

/// Standard deviations of the errors of a look at a wall: m at the centre, rad.
struct LookNoise {
  double centre_sd = 0.02, turn_sd = 0.01;         ///< new in each look
  double deviation_sd = 0, deviation_turn_sd = 0;  ///< of the piece, the same in each look
};

/// Returns what a sensor sees of the part of a piece within 6 m of its foot, with errors drawn from the
/// noise that is stated: of the centre across, and of the direction. Nothing below a metre or from behind.
std::optional<SeenLandmark> look_at_piece(const MadePiece& piece, const Pose2& sensor, Random& random,
                                          const LookNoise& noise = {}) {
  constexpr double kReach = 6;
  const Eigen::Vector2d u = (piece.to - piece.from).normalized(), normal(-u.y(), u.x());
  const double range = normal.dot(sensor.at() - piece.from), foot = u.dot(sensor.at() - piece.from);
  // To the left of the normal is against u.
  const double length = (piece.to - piece.from).norm(), middle = foot - length / 2;
  const double from = std::max(foot - length, -kReach), to = std::min(foot, kReach);
  if (!(range > 0.3 && range < 14 && to - from >= 1)) return {};
  const double centre = (from + to) / 2, turn = noise.turn_sd * random.normal();
  SeenLandmark s;
  s.type = TypeId{0};
  s.range = range - centre * turn + noise.centre_sd * random.normal() - piece.offset - middle * piece.turn;
  s.range_sd = std::hypot(noise.centre_sd, centre * noise.turn_sd);
  s.extent = {from, to, centre, noise.deviation_sd, noise.deviation_turn_sd};
  s.features.value[0] = wrap_angle(std::atan2(normal.y(), normal.x()) - sensor.yaw + turn + piece.turn);
  s.features.variance[0] = noise.turn_sd * noise.turn_sd;
  return s;
}

/// A robot on a circle in a room of 30 x 24 m. Doors of a metre cut each wall into three pieces.
class RoomDrive {
 public:
  explicit RoomDrive(std::uint64_t seed, const LookNoise& noise = {}) : random_(seed, "room"), noise_(noise) {
    const std::vector<Eigen::Vector2d> corners{{-15, -12}, {15, -12}, {15, 12}, {-15, 12}};
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d a = corners[i], run = corners[(i + 1) % 4] - a, door = run.normalized();
      for (int k = 0; k < 3; ++k)
        pieces_.push_back({a + k * run / 3 + 0.5 * door, a + (k + 1) * run / 3 - 0.5 * door});
    }
    if (noise.deviation_sd > 0)
      for (MadePiece& piece : pieces_)
        piece.offset = noise.deviation_sd * random_.normal(),
        piece.turn = noise.deviation_turn_sd * random_.normal();
  }

  BodyMotion drive() {
    const BodyMotion odometry = twist_motion(1, 0, 0.125, 0.5, kMadeNoise);
    const Eigen::Vector3d error = square_root(odometry.covariance) *
                                  Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    truth_ = truth_ * pose_of(odometry.step.vector() + error);
    return odometry;
  }

  SightingSet look() {
    const Pose2 mount{0.3, 0.1, 0.2};
    SightingSet set{mount, {}};
    for (const MadePiece& piece : pieces_)
      if (const auto s = look_at_piece(piece, truth_ * mount, random_, noise_)) set.sightings.push_back(*s);
    return set;
  }

  const Pose2& truth() const { return truth_; }

 private:
  Random random_;
  LookNoise noise_;
  std::vector<MadePiece> pieces_;
  Pose2 truth_{0, -8, 0};
};

EkfSlam line_slam(const Pose2& start, const SlamOptions& options = {}, std::vector<MapLandmark> map = {}) {
  return EkfSlam({start, Eigen::Matrix3d::Identity() * 1e-9}, LandmarkGrid(std::move(map)),
                 FeatureScales(edges()), options);
}

TEST(SlamLine, DerivativesAreThoseOfTheMeasurement) {
  Random random(3, "lines");
  for (int trial = 0; trial < 50; ++trial) {
    const auto any = [&](double limit) { return random.uniform(-limit, limit); };
    const double angle = any(3);
    const SlamLine line{.anchor = {any(9), any(9)}, .normal = {std::cos(angle), std::sin(angle)}};
    const Pose2 robot{any(9), any(9), any(3)}, mount{any(1), any(1), any(3)};
    const Eigen::Vector2d state(any(1), any(0.3));
    const ExpectedSighting e = expect(robot, mount, line, state);
    constexpr double h = 1e-6;
    const auto slope = [&](const ExpectedSighting& moved) -> Eigen::Vector2d {
      return Eigen::Vector2d(moved.value[0] - e.value[0], wrap_angle(moved.value[1] - e.value[1])) / h;
    };
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((slope(expect(pose_of(robot.vector() + h * Eigen::Vector3d::Unit(k)), mount, line, state)) -
                 e.by_pose.col(k))
                    .norm(),
                1e-4);
    for (int k = 0; k < 2; ++k)
      EXPECT_LT(
          (slope(expect(robot, mount, line, state + h * Eigen::Vector2d::Unit(k))) - e.by_landmark.col(k))
              .norm(),
          1e-4);
  }
}

// Covariance of a new line against draws of the robot's pose and of the sighting's errors.
TEST(SlamLine, ANewLineHasItsMeasuredCovariance) {
  PoseEstimate robot{{1, 2, 0.3}, Eigen::Matrix3d::Zero()};
  robot.covariance.diagonal() << 0.01, 0.04, 0.0009;
  const MadePiece wall{{8, 6}, {2, 6}};  // its normal points south
  Random random(5, "draws");
  double sum = 0, squares = 0, turns = 0;
  constexpr int kDraws = 4000;
  double stated = 0, stated_turn = 0;
  for (int i = 0; i < kDraws; ++i) {
    const SeenLandmark s = *look_at_piece(wall, robot.pose, random);
    Pose2 start = robot.pose;
    start.x += 0.1 * random.normal(), start.y += 0.2 * random.normal(), start.yaw += 0.03 * random.normal();
    EkfSlam slam({start, robot.covariance}, LandmarkGrid(), FeatureScales(edges()), {});
    slam.update({{}, {s}});
    const std::vector<SlamLandmark> all = slam.landmarks();
    ASSERT_EQ(all.size(), 1U);
    const double across = all[0].at.y() - 6, azimuth = all[0].features.value[0];
    const Eigen::Vector2d normal(std::sin(azimuth), std::cos(azimuth));
    sum += across, squares += across * across;
    turns += std::pow(wrap_angle(azimuth - std::numbers::pi), 2);
    stated += normal.dot(all[0].covariance * normal), stated_turn += all[0].features.variance[0];
    EXPECT_NEAR(all[0].features.value[1], 5, 1e-9);
    EXPECT_NEAR(all[0].covariance(0, 0), 25.0 / 12, 0.2) << "the position along it is unknown";
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.02);
  // 4000 squares: 95 % within 4.4 %; the derivatives add a little.
  EXPECT_NEAR(squares / stated, 1, 0.08);
  EXPECT_NEAR(turns / stated_turn, 1, 0.06);
}

TEST(SlamLine, PiecesOfOneWallAreOneLandmark) {
  RoomDrive drive(1);
  EkfSlam slam = line_slam(drive.truth());
  DeadReckoning odometry({drive.truth(), Eigen::Matrix3d::Identity() * 1e-9});
  for (int i = 0; i < 300; ++i) {
    const BodyMotion step = drive.drive();
    slam.predict(step);
    odometry.predict(step);
    slam.update(drive.look());
  }
  const std::vector<SlamLandmark> walls = slam.landmarks();
  ASSERT_EQ(walls.size(), 4U);
  for (const SlamLandmark& wall : walls) {
    ASSERT_TRUE(wall.line.has_value());
    const double azimuth = wall.features.value[0];
    const Eigen::Vector2d normal(std::sin(azimuth), std::cos(azimuth));
    const bool is_long = std::abs(normal.y()) > 0.5;
    // The first look fixes the direction of the room to a hundredth of a radian per wall.
    const double turn_sd = std::sqrt(wall.features.variance[0]),
                 across_sd = std::sqrt(normal.dot(wall.covariance * normal));
    EXPECT_LT(turn_sd, 0.02);
    EXPECT_LT(across_sd, 0.3);
    EXPECT_LT(std::abs(std::remainder(azimuth, std::numbers::pi / 2)), 4 * turn_sd);
    EXPECT_LT(std::abs(std::abs(is_long ? wall.at.y() : wall.at.x()) - (is_long ? 12 : 15)), 4 * across_sd);
    EXPECT_NEAR(wall.features.value[1], is_long ? 28 : 23, 2)
        << "what was seen, and errors of the pose along it";
    EXPECT_FALSE(wall.feature_samples.empty());
  }
  EXPECT_LT(nees(slam.estimate(), drive.truth()), 16.3) << "99.9 % of chi-square with three freedoms";
  EXPECT_LT(slam.estimate().covariance(2, 2), 0.01 * odometry.estimate().covariance(2, 2));
}

// The slow twin is the full filter, in which all lines stay active.
TEST(SlamLine, CompressedAndFullFilterAgree) {
  RoomDrive a(2), b(2);
  SlamOptions near, whole;
  near.margin = 2, near.max_range = 14;
  whole.margin = 1e6, whole.max_range = 14;
  EkfSlam fast = line_slam(a.truth(), near), slow = line_slam(b.truth(), whole);
  for (int i = 0; i < 150; ++i) {
    fast.predict(a.drive());
    slow.predict(b.drive());
    fast.update(a.look());
    slow.update(b.look());
    ASSERT_LT((fast.estimate().pose.vector() - slow.estimate().pose.vector()).norm(), 1e-7) << i;
    ASSERT_TRUE(fast.estimate().covariance.isApprox(slow.estimate().covariance, 1e-6)) << i;
  }
}

TEST(SlamLine, ItsCovarianceIsThatOfItsErrors) {
  const double sum = mean_nees([](std::uint64_t seed) { return RoomDrive(seed); },
                               [](const Pose2& start) { return line_slam(start); });
  // An EKF that linearises is a little above (Bailey et al. 2006): 1.26 over 1000 drives.
  EXPECT_GT(sum, 0.75);
  EXPECT_LT(sum, 1.4);
}

// A piece of wall errs alike in each look. Without its own unknowns the mean NEES is 3.8.
TEST(SlamLine, ItsCovarianceIsThatOfItsErrorsWhereWallsAreNotStraight) {
  const LookNoise wavy{.deviation_sd = 0.03, .deviation_turn_sd = 0.015};
  const double sum = mean_nees([&](std::uint64_t seed) { return RoomDrive(seed, wavy); },
                               [](const Pose2& start) { return line_slam(start); });
  EXPECT_GT(sum, 0.6);
  EXPECT_LT(sum, 1.9);
}

// Walls alone tie the graph of a drive. Each pose uses later looks as well, so that the middle of the drive
// is known better than SLAM knew it.
TEST(SlamLine, TheGraphOfADriveHasItsWalls) {
  const LookNoise wavy{.deviation_sd = 0.03, .deviation_turn_sd = 0.015};
  constexpr int kRuns = 40, kSteps = 160;
  double nees = 0, of_graph = 0, of_slam = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    RoomDrive room(seed, wavy);
    EkfSlam slam = line_slam(room.truth());
    PoseGraphBuilder drive({room.truth(), Eigen::Matrix3d::Identity() * 1e-9}, slam);
    Pose2 truth, online;
    for (int i = 0; i < kSteps; ++i) {
      drive.predict(room.drive());
      drive.update(room.look());
      if (i == kSteps / 2) truth = room.truth(), online = drive.estimate().pose;
    }
    std::vector<SlamLandmark> landmarks;
    const GraphSolution all = optimise(drive.graph(landmarks));
    ASSERT_GE(landmarks.size(), 4U);
    EXPECT_GE(all.graph.deviations.size(), 12U);
    const std::size_t middle = kSteps / 2 + 1;  // the start is the first pose
    const auto error_of = [&](const Pose2& at) {
      return Eigen::Vector3d(at.x - truth.x, at.y - truth.y, wrap_angle(at.yaw - truth.yaw));
    };
    const Eigen::Vector3d error = error_of(all.graph.poses[middle].at);
    nees += error.dot(all.pose_covariances[middle].ldlt().solve(error)) / (3 * kRuns);
    of_graph += error.head<2>().squaredNorm();
    of_slam += error_of(online).head<2>().squaredNorm();
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      landmarks[i].at = all.graph.landmarks[i].at, landmarks[i].covariance = all.landmark_covariances[i];
      state_as_position(landmarks[i]);
      const Eigen::Vector2d at = landmarks[i].at.cwiseAbs();
      EXPECT_NEAR(std::max(at.x() / 15, at.y() / 12), 1, 0.05) << "on a wall of the room";
    }
  }
  EXPECT_GT(nees, 0.7);
  EXPECT_LT(nees, 1.4);
  EXPECT_LT(of_graph, 0.95 * of_slam);
}

// However often one piece is seen, its wall is not known better than the piece deviates.
TEST(SlamLine, DeviationsOfOnePieceDoNotAverageOut) {
  const LookNoise wavy{
      .centre_sd = 0.005, .turn_sd = 0.003, .deviation_sd = 0.03, .deviation_turn_sd = 0.015};
  const MadePiece wall{{8, 6}, {2, 6}};
  const Pose2 robot{1, 2, 0.3};
  EkfSlam slam = line_slam(robot);
  Random random(5, "looks");
  for (int i = 0; i < 100; ++i) slam.update({{}, {*look_at_piece(wall, robot, random, wavy)}});
  const std::vector<SlamLandmark> all = slam.landmarks();
  ASSERT_EQ(all.size(), 1U);
  const double azimuth = all[0].features.value[0];
  const Eigen::Vector2d normal(std::sin(azimuth), std::cos(azimuth));
  EXPECT_NEAR(std::sqrt(normal.dot(all[0].covariance * normal)), 0.03, 0.001);
  EXPECT_NEAR(std::sqrt(all[0].features.variance[0]), 0.015, 0.0005);
}

TEST(SlamLine, PiecesCorrelateByThePartThatTheyShare) {
  const LinePiece a{-2, 2}, half{0, 4}, inside{-1, 0}, beside{3, 5};
  EXPECT_DOUBLE_EQ(deviation_correlation(a, a), 1);
  EXPECT_DOUBLE_EQ(deviation_correlation(a, half), 0.5);
  EXPECT_DOUBLE_EQ(deviation_correlation(a, inside), 0.5) << "1 / sqrt(4 * 1)";
  EXPECT_DOUBLE_EQ(deviation_correlation(a, beside), 0);
}

// Walls of a map fix the robot across them; the landmark keeps its key and its ends.
TEST(SlamLine, WallsOfAMapAreMatched) {
  std::vector<MapLandmark> map(2);
  const double azimuth[] = {std::numbers::pi, -std::numbers::pi / 2};  // north wall, east wall
  const Eigen::Vector2d at[] = {{4, 8}, {12, 0}};
  for (std::size_t i = 0; i < 2; ++i) {
    map[i].key = i + 1;
    map[i].at = at[i];
    map[i].normal = {std::sin(azimuth[i]), std::cos(azimuth[i])};
    map[i].half_length = 10;
    map[i].normal_variance = 1e-6;
    map[i].covariance =
        1e-4 * map[i].normal * map[i].normal.transpose() + 33 * map[i].along() * map[i].along().transpose();
    map[i].features.value[0] = azimuth[i];
    map[i].features.value[1] = 20;
  }
  const Pose2 truth{1, 2, 0.3};
  const PoseEstimate guess{{1.2, 1.8, 0.33}, Eigen::Vector3d(0.09, 0.09, 0.01).asDiagonal()};
  EkfSlam slam(guess, LandmarkGrid(map), FeatureScales(edges()), {});
  Random random(1, "map");
  for (int i = 0; i < 5; ++i) {
    const auto matches = slam.update({{},
                                      {*look_at_piece({{14, 8}, {-6, 8}}, truth, random),
                                       *look_at_piece({{12, -10}, {12, 10}}, truth, random)}});
    EXPECT_EQ(matches[0].key, 1U);
    EXPECT_EQ(matches[1].key, 2U);
    EXPECT_EQ(matches[0].at, at[0]);
  }
  EXPECT_LT((slam.estimate().pose.at() - truth.at()).norm(), 0.04);
  EXPECT_NEAR(slam.estimate().pose.yaw, 0.3, 0.015);
  const std::vector<SlamLandmark> walls = slam.landmarks();
  ASSERT_EQ(walls.size(), 2U);
  for (const SlamLandmark& wall : walls) {
    EXPECT_TRUE(wall.was_mapped);
    EXPECT_LT((wall.at - at[*wall.key - 1]).norm(), 0.05);
    EXPECT_NEAR(wall.line->to - wall.line->from, 20, 1e-9);
  }
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/error.hpp"
#include "core/random.hpp"
#include "importers/logs/graph_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/slam/graph_marginals.hpp"
#include "localization/slam/graph_solver.hpp"
#include "tests/localization/made_graph.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The slow twin: numeric derivatives, one dense matrix, Gauss-Newton with Levenberg's damping.
struct Dense {
  static Eigen::VectorXd unknowns(const PoseGraph& g) {
    Eigen::VectorXd x(3 * g.poses.size() + 2 * (g.landmarks.size() + g.deviations.size()));
    for (std::size_t i = 0; i < g.poses.size(); ++i) x.segment<3>(3 * i) = g.poses[i].at.vector();
    for (std::size_t i = 0; i < g.landmarks.size(); ++i)
      x.segment<2>(3 * g.poses.size() + 2 * i) = g.landmarks[i].at;
    for (std::size_t i = 0; i < g.deviations.size(); ++i)
      x.segment<2>(3 * g.poses.size() + 2 * (g.landmarks.size() + i)) = g.deviations[i].at;
    return x;
  }
  static PoseGraph with(PoseGraph g, const Eigen::VectorXd& x) {
    for (std::size_t i = 0; i < g.poses.size(); ++i) g.poses[i].at = pose_of(x.segment<3>(3 * i));
    for (std::size_t i = 0; i < g.landmarks.size(); ++i)
      g.landmarks[i].at = x.segment<2>(3 * g.poses.size() + 2 * i);
    for (std::size_t i = 0; i < g.deviations.size(); ++i)
      g.deviations[i].at = x.segment<2>(3 * g.poses.size() + 2 * (g.landmarks.size() + i));
    return g;
  }
  static Eigen::VectorXd errors(const PoseGraph& g) {
    std::vector<double> all;
    const auto add = [&](const auto& v) { all.insert(all.end(), v.data(), v.data() + v.size()); };
    for (const StepEdge& e : g.steps) {
      const Pose2 between = inverse(g.poses[e.from].at) * g.poses[e.to].at;
      add(Eigen::Vector3d(e.root * Eigen::Vector3d(between.x - e.step.x, between.y - e.step.y,
                                                   wrap_angle(between.yaw - e.step.yaw))));
    }
    for (const SightingEdge& e : g.sightings) {
      const Eigen::Vector2d l = g.landmarks[e.landmark].at;
      if (e.kind == SightingKind::line) {
        // Distance and direction by two points of the line.
        const SlamLine& line = *g.landmarks[e.landmark].line;
        const Eigen::Rotation2Dd turn(l[1]);
        const Eigen::Vector2d n = turn * line.normal, on = line.anchor + l[0] * n;
        const Pose2 sensor = g.poses[e.pose].at * e.robot_from_sensor;
        Eigen::Vector2d off((sensor.at() - on).dot(n), std::atan2(n.y(), n.x()) - sensor.yaw);
        if (e.deviation) off += e.by_deviation * g.deviations[*e.deviation].at;
        off -= e.value;
        off[1] = wrap_angle(off[1]);
        add(Eigen::Vector2d(e.root * off));
        continue;
      }
      const Eigen::Vector2d there =
          (inverse(g.poses[e.pose].at * e.robot_from_sensor) * Pose2{l.x(), l.y(), 0}).at();
      if (e.kind == SightingKind::position) {
        add(Eigen::Vector2d(e.root * (there - e.value)));
      } else {
        const double off = wrap_angle(std::atan2(there.y(), there.x()) - e.value[1]);
        if (e.kind == SightingKind::bearing)
          all.push_back(e.root(1, 1) * off);
        else if (e.kind == SightingKind::range)
          all.push_back(e.root(0, 0) * (there.norm() - e.value[0]));
        else
          add(Eigen::Vector2d(e.root * Eigen::Vector2d(there.norm() - e.value[0], off)));
      }
    }
    for (const PosePrior& p : g.pose_priors) {
      const Pose2& at = g.poses[p.pose].at;
      add(Eigen::Vector3d(p.root *
                          Eigen::Vector3d(at.x - p.at.x, at.y - p.at.y, wrap_angle(at.yaw - p.at.yaw))));
    }
    for (const LandmarkPrior& p : g.landmark_priors)
      add(Eigen::Vector2d(p.root * (g.landmarks[p.landmark].at - p.at)));
    for (const GraphDeviation& d : g.deviations) add(Eigen::Vector2d(d.root * d.at));
    return Eigen::Map<Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
  }
  static Eigen::MatrixXd jacobian(const PoseGraph& g) {
    const Eigen::VectorXd x = unknowns(g);
    Eigen::MatrixXd j(errors(g).size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Eigen::VectorXd up = x, down = x;
      up[i] += 1e-6, down[i] -= 1e-6;
      j.col(i) = (errors(with(g, up)) - errors(with(g, down))) / 2e-6;
    }
    return j;
  }
  /// `held`: unknowns at the front that are constant.
  static PoseGraph solved(PoseGraph g, Eigen::Index held) {
    double lambda = 1e-3;
    for (int i = 0; i < 60; ++i) {
      const Eigen::MatrixXd j = jacobian(g).rightCols(unknowns(g).size() - held);
      const Eigen::VectorXd e = errors(g);
      Eigen::MatrixXd h = j.transpose() * j;
      h.diagonal() *= 1 + lambda;
      Eigen::VectorXd x = unknowns(g);
      x.tail(h.rows()) -= h.ldlt().solve(j.transpose() * e);
      const PoseGraph next = with(g, x);
      const bool better = errors(next).squaredNorm() < e.squaredNorm();
      lambda *= better ? 0.2 : 10;
      if (better) g = next;
    }
    return g;
  }
  static Eigen::MatrixXd covariance(const PoseGraph& g, Eigen::Index held) {
    const Eigen::MatrixXd j = jacobian(g).rightCols(unknowns(g).size() - held);
    return Eigen::MatrixXd(j.transpose() * j).inverse();
  }
};

TEST(GraphError, DerivativesMatchNumericOnes) {
  Random random(1, "jacobians");
  const auto pose = [&] {
    return Pose2{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3.1, 3.1)};
  };
  for (int trial = 0; trial < 200; ++trial) {
    PoseGraph g;
    g.poses = {{.at = pose()}, {.at = pose()}};
    g.landmarks = {{.at = {random.uniform(-9, 9), random.uniform(-9, 9)}}};
    StepEdge step{.from = 0, .to = 1, .step = pose()};
    step.root << 3, 0.2, -0.1, 0, 2, 0.4, 0, 0, 5;
    SightingEdge seen;
    seen.kind = static_cast<SightingKind>(trial % 4);
    seen.value << random.uniform(1, 9), random.uniform(-1, 1);
    seen.root << 3, 0.5, 0, 2;
    const bool bearing = seen.kind == SightingKind::bearing, range = seen.kind == SightingKind::range;
    if (bearing || range) seen.root(0, 1) = 0;
    seen.robot_from_sensor = {0.5, -0.2, 0.3};
    const StepError a = step_error(step, g.poses[0].at, g.poses[1].at);
    const SightingError b = sighting_error(seen, g.poses[0].at, g.landmarks[0].at);
    g.steps = {step};
    g.sightings = {seen};
    const Eigen::MatrixXd numeric = Dense::jacobian(g);
    if (numeric.cwiseAbs().maxCoeff() > 1e4) continue;  // the numeric one stepped over the wrap of an angle
    EXPECT_TRUE(numeric.block(0, 0, 3, 3).isApprox(a.by_from, 1e-5)) << trial;
    EXPECT_TRUE(numeric.block(0, 3, 3, 3).isApprox(a.by_to, 1e-5)) << trial;
    const Eigen::Index rows = bearing || range ? 1 : 2, first = bearing ? 1 : 0;
    EXPECT_TRUE(numeric.block(3, 0, rows, 3).isApprox(b.by_pose.middleRows(first, rows), 1e-5)) << trial;
    EXPECT_TRUE(numeric.block(3, 6, rows, 2).isApprox(b.by_landmark.middleRows(first, rows), 1e-5)) << trial;
  }
}

TEST(Graph, SolutionIsThatOfTheDenseTwin) {
  for (const SightingKind kind : {SightingKind::position, SightingKind::range_bearing, SightingKind::bearing})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const MadeGraph made = made_graph(seed, 24, kind);
      const GraphSolution fast = optimise(made.graph, {.block = 8});
      // The twin starts from the truth, so that it cannot fall into another minimum.
      PoseGraph start = made.graph;
      for (std::size_t i = 0; i < start.poses.size(); ++i) start.poses[i].at = made.truth[i];
      for (std::size_t i = 0; i < start.landmarks.size(); ++i) start.landmarks[i].at = made.landmarks[i];
      const PoseGraph slow = Dense::solved(start, 3);
      EXPECT_LT(distance(fast.graph, slow), 1e-4) << "seed " << seed << " kind " << int(kind);
      EXPECT_NEAR(fast.chi2, Dense::errors(slow).squaredNorm(), 1e-6 * (1 + fast.chi2)) << "seed " << seed;
      EXPECT_TRUE(fast.converged);
      const Eigen::MatrixXd all = Dense::covariance(fast.graph, 3);
      for (std::size_t i = 1; i < made.truth.size(); ++i)
        EXPECT_TRUE(fast.pose_covariances[i].isApprox(all.block<3, 3>(3 * (i - 1), 3 * (i - 1)), 1e-4)) << i;
      const std::size_t first = 3 * (made.truth.size() - 1);
      for (std::size_t l = 0; l < made.landmarks.size(); ++l)
        EXPECT_TRUE(
            fast.landmark_covariances[l].isApprox(all.block<2, 2>(first + 2 * l, first + 2 * l), 1e-4));
      EXPECT_EQ(fast.pose_covariances[0], Eigen::Matrix3d::Zero().eval()) << "the first pose is held";
    }
}

TEST(Graph, LinesWithPiecesAreThoseOfTheDenseTwin) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    MadeGraph made = made_graph(seed, 24);
    if (seed % 2 == 0)  // lines alone, besides the steps
      made.graph.landmarks.clear(), made.graph.sightings.clear(), made.landmarks.clear();
    add_walls(made, seed);
    if (seed > 2) {
      made.graph.landmark_priors.push_back({.landmark = made.graph.landmarks.size() - 1,
                                            .at = {0.1, 0.02},
                                            .root = Eigen::Vector2d(30, 60).asDiagonal()});
      made.graph.pose_priors.push_back({.pose = 0, .at = {}, .root = Eigen::Matrix3d::Identity() * 50});
    }
    const Eigen::Index held = seed > 2 ? 0 : 3;
    const GraphSolution fast = optimise(made.graph, {.block = 8});
    PoseGraph start = made.graph;
    for (std::size_t i = 0; i < start.poses.size(); ++i) start.poses[i].at = made.truth[i];
    for (std::size_t i = 0; i < start.landmarks.size(); ++i) start.landmarks[i].at = made.landmarks[i];
    const PoseGraph slow = Dense::solved(start, held);
    EXPECT_LT(distance(fast.graph, slow), 1e-4) << "seed " << seed;
    for (std::size_t i = 0; i < slow.deviations.size(); ++i)
      EXPECT_LT((fast.graph.deviations[i].at - slow.deviations[i].at).norm(), 1e-4) << i;
    EXPECT_NEAR(fast.chi2, Dense::errors(slow).squaredNorm(), 1e-6 * (1 + fast.chi2)) << "seed " << seed;
    EXPECT_EQ(fast.residuals, std::size_t(Dense::errors(slow).size()));
    const Eigen::MatrixXd all = Dense::covariance(fast.graph, held);
    for (std::size_t i = 1; i < made.truth.size(); ++i) {
      const Eigen::Index at = 3 * Eigen::Index(i) - held;
      EXPECT_TRUE(fast.pose_covariances[i].isApprox(all.block<3, 3>(at, at), 1e-4)) << i;
    }
    for (std::size_t l = 0; l < made.landmarks.size(); ++l) {
      const Eigen::Index at = 3 * Eigen::Index(made.truth.size()) - held + 2 * Eigen::Index(l);
      EXPECT_TRUE(fast.landmark_covariances[l].isApprox(all.block<2, 2>(at, at), 1e-4)) << l;
    }
  }
}

TEST(Graph, ErrorsAreAsLargeAsTheCovariancesSayWithLines) {
  double sum = 0;
  constexpr int kRuns = 60;
  for (int seed = 1; seed <= kRuns; ++seed) {
    MadeGraph made = made_graph(std::uint64_t(seed), 40);
    made.graph.landmarks.clear(), made.graph.sightings.clear(), made.landmarks.clear();
    add_walls(made, std::uint64_t(seed));
    const GraphSolution s = optimise(made.graph);
    const Pose2 off = s.graph.poses.back().at;
    const Eigen::Vector3d e(off.x - made.truth.back().x, off.y - made.truth.back().y,
                            wrap_angle(off.yaw - made.truth.back().yaw));
    sum += e.dot(s.pose_covariances.back().ldlt().solve(e));
  }
  EXPECT_GT(sum / (3 * kRuns), 0.8);
  EXPECT_LT(sum / (3 * kRuns), 1.22);
}

TEST(Graph, ASightingOfALineNeedsALine) {
  MadeGraph made = made_graph(1, 24);
  add_walls(made, 1);
  made.graph.landmarks.back().line.reset();
  EXPECT_THROW(optimise(made.graph), std::out_of_range);
}

TEST(Graph, ErrorsAreAsLargeAsTheCovariancesSay) {
  // NEES of the last pose over 60 drives: mean of 180 squares of unit normals, 95 % band 0.80 to 1.22.
  double sum = 0, chi = 0;
  constexpr int kRuns = 60;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const MadeGraph made = made_graph(std::uint64_t(seed), 40);
    const GraphSolution s = optimise(made.graph);
    const Pose2 off = s.graph.poses.back().at;
    const Eigen::Vector3d e(off.x - made.truth.back().x, off.y - made.truth.back().y,
                            wrap_angle(off.yaw - made.truth.back().yaw));
    sum += e.dot(s.pose_covariances.back().ldlt().solve(e));
    chi += s.chi2 / double(s.residuals - s.unknowns);
  }
  EXPECT_GT(sum / (3 * kRuns), 0.8);
  EXPECT_LT(sum / (3 * kRuns), 1.22);
  EXPECT_NEAR(chi / kRuns, 1, 0.1);
}

TEST(Graph, PriorsOnLandmarksPlaceItInTheMap) {
  MadeGraph made = made_graph(5, 24);
  const Pose2 map_from_graph{100, 50, 1};
  for (std::size_t l = 0; l < made.landmarks.size(); ++l)
    made.graph.landmark_priors.push_back(
        {.landmark = l,
         .at = (map_from_graph * Pose2{made.landmarks[l].x(), made.landmarks[l].y(), 0}).at(),
         .root = Eigen::Matrix2d::Identity() * 20});
  made.graph.poses[0].at = map_from_graph;
  const GraphSolution s = optimise(made.graph);
  for (std::size_t i = 0; i < made.truth.size(); ++i)
    EXPECT_LT((s.graph.poses[i].at.at() - (map_from_graph * made.truth[i]).at()).norm(), 0.3) << i;
  EXPECT_GT(s.pose_covariances[0](0, 0), 0) << "no pose is held";
}

TEST(Graph, AKernelKeepsAWrongLoopFromBendingTheTrack) {
  MadeGraph made = made_graph(6, 40);
  StepEdge wrong{.from = 3, .to = 30, .step = {0, 0, 0}};
  wrong.root = Eigen::Matrix3d::Identity() * 50;
  made.graph.steps.push_back(wrong);
  const auto error = [&](const GraphSolution& s) {
    double most = 0;
    for (std::size_t i = 0; i < made.truth.size(); ++i)
      most = std::max(most, (s.graph.poses[i].at.at() - made.truth[i].at()).norm());
    return most;
  };
  EXPECT_GT(error(optimise(made.graph)), 1);
  EXPECT_LT(error(optimise(made.graph, {.kernel = "cauchy"})), 0.7);
}

TEST(Graph, PartsTiedByTwoLandmarksOnlyAreJoined) {
  MadeGraph made = made_graph(7, 40, SightingKind::position, 0.1);
  std::erase_if(made.graph.steps, [](const StepEdge& e) { return e.to == 20; });
  const GraphSolution s = optimise(made.graph);
  for (std::size_t i = 0; i < made.truth.size(); ++i)
    EXPECT_LT((s.graph.poses[i].at.at() - made.truth[i].at()).norm(), 0.2) << i;
}

std::filesystem::path shared(const char* file) {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/localization" / file;
}

TEST(RealGraph, VictoriaParkAndCityTreesReachTheKnownMinimum) {
  for (const auto& [file, target] : {std::pair("victoria_park/isam_victoriaPark.txt", 6184.0),
                                     std::pair("simulated/cityTrees10000.txt", 8669.0)}) {
    if (!std::filesystem::exists(shared(file))) GTEST_SKIP() << shared(file) << " is not on this machine";
    const GraphSolution s = optimise(importers::import_graph(shared(file), "isam").graph);
    EXPECT_LE(s.chi2, target) << file;
    for (const Eigen::Matrix3d& c : s.pose_covariances) ASSERT_TRUE((c.diagonal().array() >= 0).all());
    for (const Eigen::Matrix2d& c : s.landmark_covariances) ASSERT_GT(c.determinant(), 0);
  }
}

}  // namespace
}  // namespace waymark::test

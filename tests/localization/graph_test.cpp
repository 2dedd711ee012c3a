// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/error.hpp"
#include "core/random.hpp"
#include "importers/logs/graph_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/graph_marginals.hpp"
#include "localization/graph_solver.hpp"

namespace waymark::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A drive of two rounds with landmarks on both sides, every measurement with its error.
struct MadeGraph {
  PoseGraph graph;
  std::vector<Pose2> truth;
  std::vector<Eigen::Vector2d> landmarks;
};

MadeGraph made_graph(std::uint64_t seed, int poses, SightingKind kind = SightingKind::place, double noise = 1) {
  Random random(seed, "graph");
  MadeGraph made;
  for (int i = 0; i < 8; ++i) {
    const double a = 2 * std::numbers::pi * i / 8, r = i % 2 ? 6.0 : 14.0;
    made.landmarks.emplace_back(r * std::sin(a), r * std::cos(a) - 10);  // about the middle of the rounds
  }
  const double turn = 4 * std::numbers::pi / poses;
  Pose2 at;
  for (int i = 0; i < poses; ++i) {
    made.truth.push_back(at);
    made.graph.poses.push_back({.id = i, .t = double(i), .at = {}});
    if (i > 0) {
      StepEdge e;
      e.from = std::size_t(i) - 1, e.to = std::size_t(i);
      const Pose2 step = inverse(made.truth[e.from]) * at;
      e.step = {step.x + noise * 0.05 * random.normal(), step.y + noise * 0.02 * random.normal(),
                step.yaw + noise * 0.02 * random.normal()};
      e.root = Eigen::Vector3d(1 / 0.05, 1 / 0.02, 1 / 0.02).asDiagonal();
      made.graph.steps.push_back(e);
    }
    for (std::size_t l = 0; l < made.landmarks.size(); ++l) {
      const Pose2 there = inverse(at) * Pose2{made.landmarks[l].x(), made.landmarks[l].y(), 0};
      const double range = there.at().norm();
      if (range > 12) continue;
      SightingEdge e;
      e.pose = std::size_t(i);
      e.landmark = l;
      e.kind = kind;
      if (kind == SightingKind::place) {
        e.value = there.at() + noise * 0.1 * Eigen::Vector2d(random.normal(), random.normal());
        e.root = Eigen::Matrix2d::Identity() * 10;
      } else {
        e.value << range + noise * 0.1 * random.normal(),
            std::atan2(there.y, there.x) + noise * 0.02 * random.normal();
        e.root = Eigen::Vector2d(10, 50).asDiagonal();
      }
      made.graph.sightings.push_back(e);
    }
    at = at * Pose2{10 * turn, 0, -turn};
  }
  for (std::size_t l = 0; l < made.landmarks.size(); ++l)
    made.graph.landmarks.push_back({.id = std::int64_t(1000 + l)});
  return made;
}

double distance(const PoseGraph& a, const PoseGraph& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.poses.size(); ++i)
    most = std::max({most, (a.poses[i].at.at() - b.poses[i].at.at()).norm(),
                     std::abs(wrapped(a.poses[i].at.yaw - b.poses[i].at.yaw))});
  for (std::size_t i = 0; i < a.landmarks.size(); ++i)
    most = std::max(most, (a.landmarks[i].at - b.landmarks[i].at).norm());
  return most;
}

/// The slow twin: numeric derivatives, one dense matrix, Gauss-Newton with Levenberg's damping.
struct Dense {
  static Eigen::VectorXd unknowns(const PoseGraph& g) {
    Eigen::VectorXd x(3 * g.poses.size() + 2 * g.landmarks.size());
    for (std::size_t i = 0; i < g.poses.size(); ++i) x.segment<3>(3 * i) = g.poses[i].at.vector();
    for (std::size_t i = 0; i < g.landmarks.size(); ++i)
      x.segment<2>(3 * g.poses.size() + 2 * i) = g.landmarks[i].at;
    return x;
  }
  static PoseGraph with(PoseGraph g, const Eigen::VectorXd& x) {
    for (std::size_t i = 0; i < g.poses.size(); ++i) g.poses[i].at = pose_of(x.segment<3>(3 * i));
    for (std::size_t i = 0; i < g.landmarks.size(); ++i)
      g.landmarks[i].at = x.segment<2>(3 * g.poses.size() + 2 * i);
    return g;
  }
  static Eigen::VectorXd errors(const PoseGraph& g) {
    std::vector<double> all;
    const auto add = [&](const auto& v) { all.insert(all.end(), v.data(), v.data() + v.size()); };
    for (const StepEdge& e : g.steps) {
      const Pose2 between = inverse(g.poses[e.from].at) * g.poses[e.to].at;
      add(Eigen::Vector3d(e.root * Eigen::Vector3d(between.x - e.step.x, between.y - e.step.y,
                                                   wrapped(between.yaw - e.step.yaw))));
    }
    for (const SightingEdge& e : g.sightings) {
      const Eigen::Vector2d l = g.landmarks[e.landmark].at;
      const Eigen::Vector2d there =
          (inverse(g.poses[e.pose].at * e.robot_from_sensor) * Pose2{l.x(), l.y(), 0}).at();
      if (e.kind == SightingKind::place) {
        add(Eigen::Vector2d(e.root * (there - e.value)));
      } else {
        const double off = wrapped(std::atan2(there.y(), there.x()) - e.value[1]);
        if (e.kind == SightingKind::bearing)
          all.push_back(e.root(1, 1) * off);
        else
          add(Eigen::Vector2d(e.root * Eigen::Vector2d(there.norm() - e.value[0], off)));
      }
    }
    for (const PosePrior& p : g.pose_priors) {
      const Pose2& at = g.poses[p.pose].at;
      add(Eigen::Vector3d(p.root * Eigen::Vector3d(at.x - p.at.x, at.y - p.at.y, wrapped(at.yaw - p.at.yaw))));
    }
    for (const LandmarkPrior& p : g.landmark_priors)
      add(Eigen::Vector2d(p.root * (g.landmarks[p.landmark].at - p.at)));
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
  /// `held`: unknowns at the front that stay.
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
    seen.kind = static_cast<SightingKind>(trial % 3);
    seen.value << random.uniform(1, 9), random.uniform(-1, 1);
    seen.root << 3, 0.5, 0, 2;
    if (seen.kind == SightingKind::bearing) seen.root(0, 1) = 0;
    seen.robot_from_sensor = {0.5, -0.2, 0.3};
    const StepError a = step_error(step, g.poses[0].at, g.poses[1].at);
    const SightingError b = sighting_error(seen, g.poses[0].at, g.landmarks[0].at);
    g.steps = {step};
    g.sightings = {seen};
    const Eigen::MatrixXd numeric = Dense::jacobian(g);
    if (numeric.cwiseAbs().maxCoeff() > 1e4) continue;  // the numeric one stepped over the wrap of an angle
    EXPECT_TRUE(numeric.block(0, 0, 3, 3).isApprox(a.by_from, 1e-5)) << trial;
    EXPECT_TRUE(numeric.block(0, 3, 3, 3).isApprox(a.by_to, 1e-5)) << trial;
    const bool bearing = seen.kind == SightingKind::bearing;
    const Eigen::Index rows = bearing ? 1 : 2, first = bearing ? 1 : 0;
    EXPECT_TRUE(numeric.block(3, 0, rows, 3).isApprox(b.by_pose.middleRows(first, rows), 1e-5)) << trial;
    EXPECT_TRUE(numeric.block(3, 6, rows, 2).isApprox(b.by_landmark.middleRows(first, rows), 1e-5)) << trial;
  }
}

TEST(Graph, SolutionIsThatOfTheDenseTwin) {
  for (const SightingKind kind : {SightingKind::place, SightingKind::range_bearing, SightingKind::bearing})
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
        EXPECT_TRUE(fast.landmark_covariances[l].isApprox(all.block<2, 2>(first + 2 * l, first + 2 * l), 1e-4));
      EXPECT_EQ(fast.pose_covariances[0], Eigen::Matrix3d::Zero().eval()) << "the first pose is held";
    }
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
                            wrapped(off.yaw - made.truth.back().yaw));
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
  MadeGraph made = made_graph(7, 40, SightingKind::place, 0.1);
  std::erase_if(made.graph.steps, [](const StepEdge& e) { return e.to == 20; });
  const GraphSolution s = optimise(made.graph);
  for (std::size_t i = 0; i < made.truth.size(); ++i)
    EXPECT_LT((s.graph.poses[i].at.at() - made.truth[i].at()).norm(), 0.2) << i;
}

class GraphFile : public ::testing::Test {
 protected:
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("waymark_graph_" + std::to_string(::getpid()) + ".txt");
  void TearDown() override { std::filesystem::remove(file_); }

  ImportedGraph read(const std::string& text) {
    std::ofstream(file_) << text;
    return import_graph(file_, graph_format(file_));
  }
  std::string refusal(const std::string& text, const std::string& format = {}) {
    try {
      std::ofstream(file_) << text;
      const ImportedGraph g = import_graph(file_, format.empty() ? graph_format(file_) : format);
      optimise(g.graph);
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  }
};

TEST_F(GraphFile, TheSameGraphInThreeDialectsIsTheSame) {
  const auto isam = read("ODOMETRY 0 1 1 0 0.1 10 0 0 20 0 40\nODOMETRY 1 2 1 0 0.1 10 0 0 20 0 40\n"
                         "LANDMARK 0 3 2 1 5 0 4\nLANDMARK 2 3 0.1 1 5 0 4\n");
  const auto g2o = read("# made\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.1\nVERTEX_SE2 2 2 0 0.2\nVERTEX_XY 3 2 1\n"
                        "FIX 0\nEDGE_SE2 0 1 1 0 0.1 100 0 0 400 0 1600\n"
                        "EDGE_SE2 1 2 1 0 0.1 100 0 0 400 0 1600\n"
                        "EDGE_SE2_XY 0 3 2 1 25 0 16\r\nEDGE_SE2_XY 2 3 0.1 1 25 0 16\n");
  const auto toro = read("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.1\nVERTEX2 2 2 0 0.2\n"
                         "EDGE2 0 1 1 0 0.1 100 0 400 1600 0 0\nEDGE2 1 2 1 0 0.1 100 0 400 1600 0 0\n"
                         "LANDMARK 0 3 2 1 25 0 16\nLANDMARK 2 3 0.1 1 25 0 16\n");
  EXPECT_EQ(isam.format, "isam");
  EXPECT_EQ(g2o.format, "g2o");
  EXPECT_EQ(toro.format, "toro");
  const GraphSolution a = optimise(isam.graph), b = optimise(g2o.graph), c = optimise(toro.graph);
  EXPECT_GT(a.chi2, 0.01);
  EXPECT_NEAR(a.chi2, b.chi2, 1e-8);
  EXPECT_NEAR(a.chi2, c.chi2, 1e-8);
  EXPECT_LT(distance(a.graph, b.graph), 1e-5);
  EXPECT_EQ(a.graph.landmarks[0].id, 3);
}

TEST_F(GraphFile, EdgesAloneAreToldApartByTheirZeros) {
  EXPECT_EQ(read("EDGE2 0 1 1 0 0 50 0 0 50 0 100\n").format, "isam");
  EXPECT_EQ(read("EDGE2 0 1 1 0 0 50 0 50 100 0 0\n").format, "toro");
  std::ofstream(file_) << R"({"kind":"odometry","t":0,"v":1,"omega":0})" << '\n';
  EXPECT_EQ(graph_format(file_), "");
}

TEST_F(GraphFile, IsReadAsALogToo) {
  std::ofstream(file_) << "ODOMETRY 0 1 1 0 0.1 10 0 0 10 0 10\nLANDMARK 1 5 3 4 10 0 10\n";
  TypeRegistry types;
  register_landmark_types(types);
  const RobotLog log = import_log(file_, types);
  ASSERT_EQ(log.events.size(), 2u);
  ASSERT_TRUE(log.graph);
  const auto& seen = std::get<SightingSet>(log.events[1].what).sightings.at(0);
  EXPECT_NEAR(*seen.range, 5, 1e-12);
  EXPECT_NEAR(seen.bearing, std::atan2(4, 3), 1e-12);
  EXPECT_NEAR(seen.range_sd, 0.1, 1e-12);
  EXPECT_NEAR(seen.bearing_sd, 0.02, 1e-12);
  EXPECT_EQ(seen.identity, landmark_key("5"));
}

TEST_F(GraphFile, WhatIsWrongIsNamedWithItsLine) {
  const std::string good = "ODOMETRY 0 1 1 0 0 10 0 0 10 0 10\n";
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0\n"), AllOf(HasSubstr("line 2"), HasSubstr("cut off")));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0 x 10 0 0 10 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("'x' of ODOMETRY is no number")));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 nan 0 0 10 0 0 10 0 10\n"), HasSubstr("no number"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 1.5 1 0 0 10 0 0 10 0 10\n"), HasSubstr("no id"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 1 1 0 0 10 0 0 10 0 10\n"), HasSubstr("to itself"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0 0 10 0 0 0 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("not positive definite")));
  EXPECT_THAT(refusal(good + "LANDMARK 7 9 1 0 10 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("pose 7, which the graph does not have")));
  EXPECT_THAT(refusal(good + "ODOMETRY 5 6 1 0 0 10 0 0 10 0 10\n"),
              AllOf(HasSubstr("falls apart"), HasSubstr("pose 5")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 0 0 0\n"), AllOf(HasSubstr("line 2"), HasSubstr("twice")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("pose 2")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("not positive definite")));
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"), HasSubstr("in space, not in the plane"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\n"), HasSubstr("no edges"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nVERTEX_XY 9 1 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"),
              HasSubstr("landmark 9 of the graph was seen from no pose"));
}

TEST_F(GraphFile, ABearingAloneDoesNotPlaceALandmark) {
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 9 1 1\n"
                      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_BEARING_SE2_XY 0 9 0.5 100\n"),
              HasSubstr("not determined"));
}

std::filesystem::path shared(const char* file) {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/localization" / file;
}

TEST(RealGraph, VictoriaParkAndCityTreesReachTheKnownMinimum) {
  for (const auto& [file, target] : {std::pair("victoria_park/isam_victoriaPark.txt", 6184.0),
                                     std::pair("simulated/cityTrees10000.txt", 8669.0)}) {
    if (!std::filesystem::exists(shared(file))) GTEST_SKIP() << shared(file) << " is not on this machine";
    const GraphSolution s = optimise(import_graph(shared(file), "isam").graph);
    EXPECT_LE(s.chi2, target) << file;
    for (const Eigen::Matrix3d& c : s.pose_covariances) ASSERT_TRUE((c.diagonal().array() >= 0).all());
    for (const Eigen::Matrix2d& c : s.landmark_covariances) ASSERT_GT(c.determinant(), 0);
  }
}

}  // namespace
}  // namespace waymark::testing

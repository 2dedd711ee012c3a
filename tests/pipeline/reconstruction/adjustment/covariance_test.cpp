// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/frame_changes.hpp"
#include "pipeline/reconstruction/adjustment/solve_network.hpp"
#include "tests/pipeline/reconstruction/made_scene.hpp"

namespace waymark::test {
namespace {
using namespace pipeline;

// Normal matrix of all unknowns: cameras first, then points.
Eigen::MatrixXd full_normals(const Network& network) {
  const Eigen::Index cameras = network.camera_columns, all = cameras + network.point_columns;
  Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(all, all);
  for (const auto& term : network.terms) {
    Term::Linear linear;
    if (!network.linearize(*term, linear)) continue;
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(term->rows, all);
    for (std::size_t i = 0; i < term->blocks.size(); ++i) {
      const Block& block = network.blocks[term->blocks[i]];
      const Eigen::Index first = block.column + (block.kind == Block::Kind::point ? cameras : 0);
      for (std::size_t k = 0; k < block.free.size(); ++k)
        row.col(first + static_cast<Eigen::Index>(k)) += linear.by_block[i].col(block.free[k]);
    }
    normals += row.transpose() * row;
  }
  return normals;
}

// Slow twin: pseudo-inverse by all eigenvalues but the smallest `free`, then moved to the inner constraints
// on the cameras (S-transformation, Baarda 1973).
Eigen::MatrixXd full_covariance(const Network& network, Eigen::Index free) {
  const Eigen::MatrixXd normals = full_normals(network);
  const Eigen::VectorXd scale = normals.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(scale.asDiagonal() * normals *
                                                             scale.asDiagonal());
  const Eigen::Index used = normals.rows() - free;
  const Eigen::MatrixXd vectors = scale.asDiagonal() * parts.eigenvectors().rightCols(used);
  Eigen::MatrixXd covariance =
      vectors * parts.eigenvalues().tail(used).cwiseInverse().asDiagonal() * vectors.transpose();
  if (free == 0) return covariance;
  const Eigen::MatrixXd null = scale.asDiagonal() * parts.eigenvectors().leftCols(free);
  Eigen::MatrixXd constraints = Eigen::MatrixXd::Zero(normals.rows(), free);
  constraints.topRows(network.camera_columns) =
      inner_constraint_weights(network).asDiagonal() * null.topRows(network.camera_columns);
  const Eigen::MatrixXd move = Eigen::MatrixXd::Identity(normals.rows(), normals.rows()) -
                               null * (constraints.transpose() * null).inverse() * constraints.transpose();
  return move * covariance * move.transpose();
}

void expect_twin(MadeScene made, const Observations& seen, const AdjustmentOptions& options, int free) {
  BuiltNetwork built = build_network(made.start, seen, options, {});
  ASSERT_TRUE(solve(built.network, {}).usable);
  const NetworkCovariance fast = covariance(built.network);
  ASSERT_TRUE(fast.determined);
  ASSERT_EQ(fast.free_datum, free);
  const Eigen::MatrixXd slow = full_covariance(built.network, free);
  const Eigen::Index cameras = built.network.camera_columns;
  const Eigen::VectorXd sd = slow.diagonal().cwiseSqrt();
  const Eigen::MatrixXd miss = sd.head(cameras).cwiseInverse().asDiagonal() *
                               (fast.cameras - slow.topLeftCorner(cameras, cameras)) *
                               sd.head(cameras).cwiseInverse().asDiagonal();
  EXPECT_LT(miss.cwiseAbs().maxCoeff(), 1e-6);
  for (std::size_t i = 0; i < built.network.blocks.size(); ++i) {
    const Block& block = built.network.blocks[i];
    if (block.kind != Block::Kind::point || block.free.size() != 3) continue;
    ASSERT_TRUE(fast.points[i]);
    const Eigen::Matrix3d twin = slow.block<3, 3>(cameras + block.column, cameras + block.column);
    EXPECT_LT((*fast.points[i] - twin).norm(), 1e-6 * twin.norm());
  }
}

MadeSceneOptions small(std::uint64_t seed) {
  return {.seed = seed, .columns = 3, .rows = 2, .tilt = 0.2, .points = 40};
}

TEST(Covariance, FixedFrameMatchesTheFullInverse) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const MadeScene made = made_scene(small(seed));
    Observations seen{.positions = made_positions(made.truth, 0.2, seed)};
    seen.control = made_control(made, small(seed), 2, 2, 0.02);
    AdjustmentOptions options;
    options.free_lens_parameters = {{"f", "k1"}};
    expect_twin(made, seen, options, 0);
  }
}

TEST(Covariance, FreeFrameMatchesThePseudoInverse) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const MadeScene made = made_scene(small(seed));
    AdjustmentOptions options;
    options.free_lens_parameters = {{"f"}};
    expect_twin(made, {}, options, 7);
    const auto positions = made_positions(made.truth, 0.2, seed);
    expect_twin(made, {.positions = {positions[0]}}, options, 4);
    options.fixed_images = {1};
    expect_twin(made, {}, options, 1);
  }
}

// Two images of a plane's worth of points say nothing about k3 and the aspect together with all else.
TEST(Covariance, UndeterminedLensesAreReported) {
  MadeScene made = made_scene({.seed = 4, .columns = 2, .rows = 1, .relief = 0, .points = 6});
  AdjustmentOptions options;
  options.free_lens_parameters = {{"f", "aspect", "cx", "cy", "k1", "k2", "k3", "p1", "p2"}};
  const BuiltNetwork built = build_network(made.truth, {}, options, {});
  EXPECT_FALSE(covariance(built.network).determined);
}

}  // namespace
}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "core/random.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using Slot = SlamState::Slot;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, Random& random) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

Eigen::Matrix2d random_covariance(Random& random) {
  const Eigen::Matrix2d root = random_matrix(2, 2, random);
  return root * root.transpose() + 0.01 * Eigen::Matrix2d::Identity();
}

/// Slow twin: the textbook's extended Kalman filter, all landmarks in one dense covariance.
struct FullFilter {
  Pose2 pose;
  Eigen::MatrixXd p;
  std::vector<Slot> slots;
  std::vector<Eigen::Vector2d> at;

  Eigen::Index row(Slot slot) const { return 3 + 2 * (std::ranges::find(slots, slot) - slots.begin()); }

  void predict(const BodyMotion& motion) {
    Eigen::MatrixXd f = Eigen::MatrixXd::Identity(p.rows(), p.rows());
    f.topLeftCorner<3, 3>() = motion_jacobians(pose, motion.step).by_pose;
    const PoseEstimate robot = predict_pose({pose, p.topLeftCorner<3, 3>()}, motion);
    p = (f * p * f.transpose()).eval();
    p.topLeftCorner<3, 3>() = robot.covariance;
    pose = robot.pose;
  }

  void add(Slot slot, const Eigen::Vector2d& landmark, const Eigen::Matrix<double, 2, 3>& by_pose,
           const Eigen::Matrix2d& own, std::optional<Slot> deviation = {},
           const Eigen::Matrix2d& by_deviation = Eigen::Matrix2d::Zero()) {
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(p.rows() + 2, p.rows());
    g.topRows(p.rows()).setIdentity();
    g.bottomLeftCorner<2, 3>() = by_pose;
    if (deviation) g.block<2, 2>(p.rows(), row(*deviation)) = by_deviation;
    p = (g * p * g.transpose()).eval();
    p.bottomRightCorner<2, 2>() += own;
    slots.push_back(slot), at.push_back(landmark);
  }

  void remove(Slot slot) {
    const Eigen::Index l = row(slot);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < p.rows(); ++i)
      if (i != l && i != l + 1) kept.push_back(i);
    p = p(kept, kept).eval();
    at.erase(at.begin() + (l - 3) / 2), slots.erase(slots.begin() + (l - 3) / 2);
  }

  void update(const std::vector<SlamState::Correction>& corrections) {
    const auto m = 2 * std::ssize(corrections);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(m, p.rows()), r = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd v(m);
    for (Eigen::Index k = 0; k < m; k += 2) {
      const SlamState::Correction& c = corrections[static_cast<std::size_t>(k / 2)];
      h.block<2, 3>(k, 0) = c.by_pose;
      h.block<2, 2>(k, row(c.slot)) = c.by_landmark;
      if (c.deviation) h.block<2, 2>(k, row(*c.deviation)) = c.by_deviation;
      r.block<2, 2>(k, k) = c.noise;
      v.segment<2>(k) = c.innovation;
    }
    correct(h, r, v);
  }

  template <int Rows>
  void update(const FixInnovation<Rows>& fix) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(fix.value.size(), p.rows());
    h.leftCols<3>() = fix.by_pose;
    correct(h, fix.noise, fix.value);
  }

  void correct(const Eigen::MatrixXd& h, const Eigen::MatrixXd& r, const Eigen::VectorXd& v) {
    const Eigen::MatrixXd gain = p * h.transpose() * (h * p * h.transpose() + r).inverse();
    const Eigen::VectorXd step = gain * v;
    pose = pose_of(pose.vector() + step.head<3>());
    for (std::size_t i = 0; i < at.size(); ++i)
      at[i] += step.segment<2>(3 + 2 * static_cast<Eigen::Index>(i));
    p = ((Eigen::MatrixXd::Identity(p.rows(), p.rows()) - gain * h) * p).eval();
  }
};

void expect_equal(const SlamState& state, const FullFilter& twin, std::uint64_t seed) {
  std::vector<Slot> order;
  const Eigen::MatrixXd all = state.full_covariance(order);
  std::vector<Eigen::Index> rows{0, 1, 2};
  for (const Slot slot : order) rows.push_back(twin.row(slot)), rows.push_back(twin.row(slot) + 1);
  ASSERT_EQ(all.rows(), twin.p.rows()) << "seed " << seed;
  const double scale = twin.p.cwiseAbs().maxCoeff();
  EXPECT_LT((all - twin.p(rows, rows)).cwiseAbs().maxCoeff(), 1e-10 * scale) << "seed " << seed;
  EXPECT_LT((state.pose().vector() - twin.pose.vector()).norm(), 1e-9 * scale) << "seed " << seed;
}

// Landmarks come, are measured, once or twice in a set, leave and return at random; fixes come between; new
// landmarks may lie anywhere. More passive ones than a block of columns holds.
TEST(SlamState, IsTheFullFilterForAnySequenceOfCalls) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    Random random(seed, "slam state");
    const PoseEstimate start{{1, 2, 0.3}, Eigen::Vector3d(0.2, 0.1, 0.01).asDiagonal()};
    SlamState state(start);
    FullFilter twin{start.pose, start.covariance, {}, {}};
    for (int i = 0; i < 120; ++i) {
      const BodyMotion motion{{random.normal(), 0.1 * random.normal(), random.normal()},
                              Eigen::Vector3d(0.01, 0.001, 0.0001).asDiagonal()};
      state.predict(motion), twin.predict(motion);
      if (random.bernoulli(0.7)) {
        const Eigen::Vector2d at = state.pose().at() + 8 * Eigen::Vector2d(random_matrix(2, 1, random));
        Eigen::Matrix<double, 2, 3> by_pose = random_matrix(2, 3, random);
        if (random.bernoulli(0.5)) by_pose.setZero();
        const Eigen::Matrix2d own = random_covariance(random);
        const Slot deviation = state.add(at, by_pose, own);
        twin.add(deviation, at, by_pose, own);
        if (random.bernoulli(0.3)) {
          const Eigen::Matrix2d by_deviation = random_matrix(2, 2, random);
          twin.add(state.add(at, by_pose, own, deviation, by_deviation), at, by_pose, own, deviation,
                   by_deviation);
        }
      }
      if (random.bernoulli(0.15)) {
        state.focus(seed % 5 == 0 ? 0 : random.uniform(0, 15));
        if (random.bernoulli(0.2)) state.focus(5);
      }
      const std::vector<Slot> active(state.active().begin(), state.active().end());
      if (!active.empty() && random.bernoulli(0.15)) {
        const Slot gone = active[random.uniform_index(active.size())];
        state.remove(gone), twin.remove(gone);
        continue;
      }
      if (random.bernoulli(0.2)) {
        const Pose2 pose = state.pose();
        const auto update = [&](const auto& fix) { state.update(fix), twin.update(fix); };
        if (random.bernoulli(0.5))
          update(innovation(pose, GnssFix{pose.at() + Eigen::Vector2d(0.1, -0.2), 0.5}));
        else
          update(innovation(pose, HeadingFix{pose.yaw + 0.01, 0.02}));
      }
      std::vector<SlamState::Correction> corrections;
      for (const Slot slot : active)
        for (int k = 0; k < 2; ++k)
          if (random.bernoulli(0.2)) {
            corrections.push_back({slot, 0.1 * Eigen::Vector2d(random_matrix(2, 1, random)),
                                   Eigen::Matrix<double, 2, 3>(random_matrix(2, 3, random)),
                                   Eigen::Matrix2d(random_matrix(2, 2, random)), random_covariance(random)});
            const Slot other = active[random.uniform_index(active.size())];
            if (other == slot || random.bernoulli(0.5)) continue;
            corrections.back().deviation = other;
            corrections.back().by_deviation = random_matrix(2, 2, random);
          }
      if (corrections.empty()) continue;
      state.update(corrections), twin.update(corrections);
    }
    expect_equal(state, twin, seed);
    state.focus(10);
    expect_equal(state, twin, seed);
    for (std::size_t i = 0; i < twin.slots.size(); ++i)
      EXPECT_LT((state.at(twin.slots[i]) - twin.at[i]).norm(), 1e-8) << "seed " << seed;
  }
}

}  // namespace
}  // namespace waymark::test

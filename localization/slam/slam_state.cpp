// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_state.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "core/solve.hpp"

namespace waymark::localization {
namespace {

using Eigen::Index;
constexpr Index kBlock = 64;

void mirror(Eigen::MatrixXd& p) {
  p.triangularView<Eigen::StrictlyUpper>() = p.transpose();
}

}  // namespace

SlamState::SlamState(const PoseEstimate& start)
    : pose_(start.pose),
      paa_(start.covariance),
      pab_(3, 0),
      pbb_(0, 0),
      phi_(Eigen::Matrix3d::Identity()),
      psi_(Eigen::Matrix3d::Zero()),
      theta_(Eigen::Vector3d::Zero()),
      measured_{0, 1, 2} {}

Eigen::Matrix2d SlamState::covariance(Slot slot) const {
  if (index_[slot] < active_.size() && active_[index_[slot]] == slot)
    return paa_.block<2, 2>(row(slot), row(slot));
  const Index i = 2 * static_cast<Index>(index_[slot]);
  return pbb_.block<2, 2>(i, i);
}

Eigen::Matrix<double, 2, 3> SlamState::cross(Slot slot) const {
  return paa_.block<2, 3>(row(slot), 0);
}

void SlamState::predict(const BodyMotion& motion) {
  const MotionJacobians j = motion_jacobians(pose_, motion.step);
  const PoseEstimate robot = predict_pose({pose_, covariance()}, motion);
  const Index rest = paa_.rows() - 3;
  const Eigen::MatrixXd turned = j.by_pose * paa_.topRightCorner(3, rest);
  paa_.topRightCorner(3, rest) = turned;
  paa_.bottomLeftCorner(rest, 3) = turned.transpose();
  paa_.topLeftCorner<3, 3>() = robot.covariance;
  phi_.topRows<3>() = (j.by_pose * phi_.topRows<3>()).eval();
  pose_ = robot.pose;
}

// Returns the covariance of rows of the state with an innovation.
template <int Rows>
Eigen::Matrix<double, Rows, 2> SlamState::with_innovation(Index first_row, const Correction& of) const {
  Eigen::Matrix<double, Rows, 2> with =
      paa_.block<Rows, 3>(first_row, 0) * of.by_pose.transpose() +
      paa_.block<Rows, 2>(first_row, row(of.slot)) * of.by_landmark.transpose();
  if (of.deviation) with += paa_.block<Rows, 2>(first_row, row(*of.deviation)) * of.by_deviation.transpose();
  return with;
}

double SlamState::joint_squares(std::span<const Correction> corrections) const {
  if (corrections.empty()) return 0;
  const Index m = 2 * static_cast<Index>(corrections.size());
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(m, m);
  Eigen::VectorXd v(m);
  for (Index i = 0; i < m; i += 2) {
    const Correction& a = corrections[static_cast<std::size_t>(i / 2)];
    v.segment<2>(i) = a.innovation;
    s.block<2, 2>(i, i) = a.noise;
    for (Index j = 0; j < m; j += 2) {
      const Correction& b = corrections[static_cast<std::size_t>(j / 2)];
      s.block<2, 2>(i, j) +=
          a.by_pose * with_innovation<3>(0, b) + a.by_landmark * with_innovation<2>(row(a.slot), b);
      if (a.deviation) s.block<2, 2>(i, j) += a.by_deviation * with_innovation<2>(row(*a.deviation), b);
    }
  }
  const Cholesky root((s + s.transpose()) / 2);
  if (!root.positive_definite()) return std::numeric_limits<double>::infinity();
  return v.dot(root.solve(v));
}

// Gives a landmark its columns of phi and psi before it is measured first: until then those of the identity
// and of zero.
void SlamState::add_column(Slot slot) {
  Index& omitted = identity_[index_[slot]];
  if (omitted < 0) return;
  const Index old = phi_.cols();
  phi_.conservativeResize(Eigen::NoChange, old + 2);
  phi_.rightCols<2>().setZero();
  phi_.block<2, 2>(row(slot), old).setIdentity();
  psi_.conservativeResize(old + 2, old + 2);
  psi_.rightCols<2>().setZero();
  psi_.bottomRows<2>().setZero();
  theta_.conservativeResize(old + 2);
  theta_.tail<2>().setZero();
  measured_.push_back(omitted);
  measured_.push_back(omitted + 1);
  omitted = -1;
}

Eigen::MatrixXd SlamState::measured_rows() const {
  return pab_(measured_, Eigen::all);
}

void SlamState::update(std::span<const Correction> corrections) {
  if (corrections.empty()) return;
  const bool has_passive = pbb_.rows() > 0;
  if (has_passive)
    for (const Correction& c : corrections) {
      add_column(c.slot);
      if (c.deviation) add_column(*c.deviation);
    }
  const Index n = paa_.rows(), m = 2 * static_cast<Index>(corrections.size());
  Eigen::MatrixXd ph(n, m), h_phi(m, phi_.cols()), s = Eigen::MatrixXd::Zero(m, m);
  Eigen::VectorXd v(m);
  for (Index k = 0; k < m; k += 2) {
    const Correction& c = corrections[static_cast<std::size_t>(k / 2)];
    const Index l = row(c.slot);
    ph.middleCols<2>(k).noalias() = paa_.leftCols<3>() * c.by_pose.transpose();
    ph.middleCols<2>(k).noalias() += paa_.middleCols<2>(l) * c.by_landmark.transpose();
    if (c.deviation)
      ph.middleCols<2>(k).noalias() += paa_.middleCols<2>(row(*c.deviation)) * c.by_deviation.transpose();
    if (has_passive) {
      h_phi.middleRows<2>(k).noalias() = c.by_pose * phi_.topRows<3>();
      h_phi.middleRows<2>(k).noalias() += c.by_landmark * phi_.middleRows<2>(l);
      if (c.deviation)
        h_phi.middleRows<2>(k).noalias() += c.by_deviation * phi_.middleRows<2>(row(*c.deviation));
    }
    s.block<2, 2>(k, k) = c.noise;
    v.segment<2>(k) = c.innovation;
  }
  for (Index k = 0; k < m; k += 2) {
    const Correction& c = corrections[static_cast<std::size_t>(k / 2)];
    s.middleRows<2>(k) += c.by_pose * ph.topRows<3>() + c.by_landmark * ph.middleRows<2>(row(c.slot));
    if (c.deviation) s.middleRows<2>(k) += c.by_deviation * ph.middleRows<2>(row(*c.deviation));
  }
  correct(ph, h_phi, s, v);
}

template <int Rows>
void SlamState::update(const FixInnovation<Rows>& fix) {
  const Eigen::MatrixXd ph = paa_.leftCols<3>() * fix.by_pose.transpose();
  correct(ph, fix.by_pose * phi_.topRows<3>(), fix.by_pose * ph.topRows<3>() + fix.noise, fix.value);
}
template void SlamState::update(const FixInnovation<1>&);
template void SlamState::update(const FixInnovation<2>&);

// Applies a measurement: covariance of the state with it, its rows of phi, and the covariance of the
// innovation.
void SlamState::correct(const Eigen::MatrixXd& ph, const Eigen::MatrixXd& h_phi, const Eigen::MatrixXd& s,
                        const Eigen::VectorXd& v) {
  const bool has_passive = pbb_.rows() > 0;
  const Cholesky root((s + s.transpose()) / 2);
  if (!root.positive_definite()) return;  // not positive definite: skip the update
  const Eigen::MatrixXd gain = root.solve(Eigen::MatrixXd(ph.transpose())).transpose();
  const Eigen::VectorXd step = gain * v;
  if (!step.allFinite()) return;
  pose_ = pose_of(pose_.vector() + step.head<3>());
  for (std::size_t i = 0; i < active_.size(); ++i)
    at_[active_[i]] += step.segment<2>(3 + 2 * static_cast<Index>(i));
  if (has_passive) {
    const Eigen::MatrixXd weighed = root.solve(h_phi);
    theta_.noalias() += h_phi.transpose() * root.solve(v);
    psi_.noalias() += h_phi.transpose() * weighed;
    phi_.noalias() -= gain * h_phi;
  }
  // Joseph: (I - KH) P (I - KH)' + KRK' = P - K (2 PH' - KS)' for P symmetric.
  const Eigen::MatrixXd rest = 2 * ph - gain * s;
  paa_.triangularView<Eigen::Lower>() -= gain * rest.transpose();
  mirror(paa_);
}

SlamState::Slot SlamState::append(const Eigen::Vector2d& at) {
  at_.push_back(at);
  site_.emplace_back();
  index_.push_back(active_.size());
  active_.push_back(at_.size() - 1);
  identity_.push_back(-1);
  return at_.size() - 1;
}

SlamState::Slot SlamState::add(const Eigen::Vector2d& at, const Eigen::Matrix<double, 2, 3>& by_pose,
                               const Eigen::Matrix2d& own) {
  const Index n = paa_.rows();
  const Eigen::MatrixXd cross = by_pose * paa_.topRows<3>();
  const Eigen::MatrixXd passive = by_pose * phi_.topRows<3>();
  const Eigen::Matrix2d both = by_pose * covariance() * by_pose.transpose() + own;
  paa_.conservativeResize(n + 2, n + 2);
  paa_.block(n, 0, 2, n) = cross;
  paa_.block(0, n, n, 2) = cross.transpose();
  paa_.bottomRightCorner<2, 2>() = (both + both.transpose()) / 2;
  phi_.conservativeResize(n + 2, Eigen::NoChange);
  phi_.bottomRows<2>() = passive;
  return append(at);
}

SlamState::Slot SlamState::add(const Eigen::Vector2d& at, const Eigen::Matrix<double, 2, 3>& by_pose,
                               const Eigen::Matrix2d& own, Slot deviation,
                               const Eigen::Matrix2d& by_deviation) {
  const Index n = paa_.rows();
  const Index from = row(deviation);
  const Slot slot = add(at, by_pose, own);
  const Eigen::Matrix<double, 2, Eigen::Dynamic> more = by_deviation * paa_.middleRows<2>(from);
  const Eigen::Matrix2d both = more.leftCols<3>() * by_pose.transpose();
  const Eigen::Matrix2d squares = by_deviation * paa_.block<2, 2>(from, from) * by_deviation.transpose();
  paa_.block(n, 0, 2, n) += more.leftCols(n);
  paa_.block(0, n, n, 2) += more.leftCols(n).transpose();
  paa_.bottomRightCorner<2, 2>() += both + both.transpose() + squares;
  phi_.bottomRows<2>() += by_deviation * phi_.middleRows<2>(from);
  return slot;
}

SlamState::Slot SlamState::add(const Eigen::Vector2d& at, const Eigen::Matrix2d& covariance) {
  return add(at, Eigen::Matrix<double, 2, 3>::Zero(), covariance);
}

void SlamState::set_site(Slot slot, const Eigen::Vector2d& centre, double radius) {
  site_[slot] = Site{centre, radius};
}

double SlamState::distance_to(Slot slot) const {
  const std::optional<Site>& site = site_[slot];
  return site ? (site->centre - pose_.at()).norm() - site->radius : (at_[slot] - pose_.at()).norm();
}

void SlamState::remove(Slot slot) {
  const Index l = row(slot), n = paa_.rows(), rest = n - l - 2;
  paa_.middleRows(l, rest) = paa_.bottomRows(rest).eval();
  paa_.middleCols(l, rest) = paa_.rightCols(rest).eval();
  paa_.conservativeResize(n - 2, n - 2);
  phi_.middleRows(l, rest) = phi_.bottomRows(rest).eval();
  phi_.conservativeResize(n - 2, Eigen::NoChange);
  active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(index_[slot]));
  identity_.erase(identity_.begin() + static_cast<std::ptrdiff_t>(index_[slot]));
  for (std::size_t i = index_[slot]; i < active_.size(); ++i) index_[active_[i]] = i;
}

Eigen::MatrixXd SlamState::full_covariance(std::vector<Slot>& order) const {
  order = active_;
  order.insert(order.end(), passive_.begin(), passive_.end());
  const Index a = paa_.rows(), b = pbb_.rows();
  Eigen::MatrixXd all(a + b, a + b);
  all.topLeftCorner(a, a) = paa_;
  if (b > 0) {
    const Eigen::MatrixXd measured = measured_rows();
    // In blocks of columns, the same for any number of threads.
    tbb::parallel_for(Index{0}, (b + kBlock - 1) / kBlock, [&](Index k) {
      const Index j = k * kBlock, width = std::min(kBlock, b - j), below = b - j;
      const auto part = measured.middleCols(j, width);
      auto with_active = all.block(0, a + j, a, width);
      with_active.noalias() = phi_ * part;
      for (std::size_t i = 0; i < active_.size(); ++i)
        if (identity_[i] >= 0)
          with_active.middleRows<2>(3 + 2 * static_cast<Index>(i)) += pab_.block(identity_[i], j, 2, width);
      all.block(a + j, 0, width, a) = with_active.transpose();
      const Eigen::MatrixXd lost = psi_ * part;
      auto rest = all.block(a + j, a + j, below, width);
      rest = pbb_.block(j, j, below, width);
      rest.noalias() -= measured.rightCols(below).transpose() * lost;
      for (Index c = 1; c < width; ++c)
        for (Index r = 0; r < c; ++r) rest(r, c) = rest(c, r);
      const Index beyond = below - width;
      all.block(a + j, a + j + width, width, beyond) = rest.bottomRows(beyond).transpose();
    });
  }
  return all;
}

void SlamState::focus(double radius) {
  std::vector<Slot> order;
  const Eigen::MatrixXd all = full_covariance(order);
  if (pbb_.rows() > 0) {
    const Eigen::VectorXd step = measured_rows().transpose() * theta_;
    for (std::size_t i = 0; i < passive_.size(); ++i)
      at_[passive_[i]] += step.segment<2>(2 * static_cast<Index>(i));
  }
  std::vector<Index> near{0, 1, 2}, far;
  active_.clear(), passive_.clear();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Slot slot = order[i];
    const bool is_near = distance_to(slot) <= radius;
    std::vector<Slot>& part = is_near ? active_ : passive_;
    index_[slot] = part.size();
    part.push_back(slot);
    const Index r = 3 + 2 * static_cast<Index>(i);
    std::vector<Index>& rows = is_near ? near : far;
    rows.push_back(r);
    rows.push_back(r + 1);
  }
  paa_ = all(near, near);
  pab_ = all(near, far);
  pbb_ = all(far, far);
  phi_ = Eigen::MatrixXd::Identity(paa_.rows(), 3);
  psi_ = Eigen::Matrix3d::Zero();
  theta_ = Eigen::Vector3d::Zero();
  measured_ = {0, 1, 2};
  identity_.clear();
  for (std::size_t i = 0; i < active_.size(); ++i) identity_.push_back(3 + 2 * static_cast<Index>(i));
}

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/frame_changes.hpp"

#include <Eigen/Eigenvalues>

namespace waymark::pipeline {
namespace {

constexpr Eigen::Index kChanges = 8;  // translation, rotation, scale, height bias

// Mean of the cameras and root mean square distance from it.
struct Extent {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double size = 1;
};

Extent extent_of(const Network& network) {
  Extent extent;
  double count = 0, squares = 0;
  const auto each_centre = [&](auto use) {
    for (const Block& block : network.blocks)
      if (block.kind == Block::Kind::pose) use(Eigen::Vector3d(block.value.tail<3>()));
  };
  each_centre([&](const Eigen::Vector3d& c) { extent.middle += c, ++count; });
  if (count > 0) extent.middle /= count;
  each_centre([&](const Eigen::Vector3d& c) { squares += (c - extent.middle).squaredNorm(); });
  if (squares > 0) extent.size = std::sqrt(squares / count);
  return extent;
}

// Changes of a block under changes of the frame by one metre, or by one metre at the distance of the cameras.
Eigen::MatrixXd frame_changes(const Block& block, const Extent& extent) {
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(block.changes(), kChanges);
  if (block.kind == Block::Kind::lens) return by;
  if (block.kind == Block::Kind::bias) {
    by(0, 7) = 1;
    return by;
  }
  if (block.kind == Block::Kind::motion) {  // the shift turns and grows with the frame
    const Eigen::Vector3d shift = Eigen::Vector3d(block.value.head<3>()) / extent.size;
    by.block<3, 3>(0, 3) << 0, shift.z(), -shift.y(), -shift.z(), 0, shift.x(), shift.y(), -shift.x(), 0;
    by.block<3, 1>(0, 6) = shift;
    return by;
  }
  const bool pose = block.kind == Block::Kind::pose;
  const Eigen::Vector3d at = (Eigen::Vector3d(block.value.tail<3>()) - extent.middle) / extent.size;
  const Eigen::Index row = pose ? 3 : 0;
  by.block<3, 3>(row, 0).setIdentity();
  by.block<3, 3>(row, 3) << 0, at.z(), -at.y(), -at.z(), 0, at.x(), at.y(), -at.x(), 0;
  by.block<3, 1>(row, 6) = at;
  if (pose) by.block<3, 3>(0, 3) = pose_of(block.value.data()).linear().transpose() / extent.size;
  return by;
}

// Basis of the directions in which a positive semidefinite matrix vanishes.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& m) {
  constexpr double kZero = 1e-10;
  if (m.cols() == 0) return m;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(m);
  const double largest = parts.eigenvalues().maxCoeff();
  Eigen::Index count = 0;
  while (count < m.cols() && !(parts.eigenvalues()[count] > kZero * largest)) ++count;
  return parts.eigenvectors().leftCols(count);
}

}  // namespace

Eigen::MatrixXd free_frame_changes(const Network& network) {
  const Extent extent = extent_of(network);
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(kChanges, kChanges), seen = held;
  bool bias = false;
  for (const Block& block : network.blocks) {
    // A motion that is held follows the poses, and holds no frame.
    if (block.kind == Block::Kind::lens || block.kind == Block::Kind::motion) continue;
    bias = bias || block.kind == Block::Kind::bias;
    if (static_cast<Eigen::Index>(block.free.size()) == block.changes()) continue;
    Eigen::MatrixXd by = frame_changes(block, extent);
    for (const int component : block.free) by.row(component).setZero();
    held += by.transpose() * by;
  }
  if (!bias) held(7, 7) += 1;
  for (const auto& term : network.terms) {
    Term::Linear linear;
    const bool in_any_frame = term->is_mark() || term->kind == Term::Kind::motion;
    if (in_any_frame || !network.linearize(*term, linear)) continue;
    Eigen::MatrixXd by = Eigen::MatrixXd::Zero(term->rows, kChanges);
    for (std::size_t i = 0; i < term->blocks.size(); ++i)
      by += linear.by_block[i] * frame_changes(network.blocks[term->blocks[i]], extent);
    seen += by.transpose() * by;
  }
  Eigen::MatrixXd free = null_space(held);
  free = (free * null_space(free.transpose() * seen * free)).eval();
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(network.camera_columns, free.cols());
  for (const Block& block : network.blocks) {
    if (block.kind == Block::Kind::point || block.free.empty()) continue;
    const Eigen::MatrixXd by = frame_changes(block, extent) * free;
    for (std::size_t i = 0; i < block.free.size(); ++i)
      changes.row(block.column + static_cast<Eigen::Index>(i)) = by.row(block.free[i]);
  }
  return changes;
}

Eigen::VectorXd inner_constraint_weights(const Network& network) {
  const double size = extent_of(network).size;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(network.camera_columns);
  for (const Block& block : network.blocks)
    if (block.kind == Block::Kind::pose)
      for (std::size_t i = 0; i < block.free.size(); ++i)
        weights[block.column + static_cast<Eigen::Index>(i)] = block.free[i] < 3 ? size * size : 1;
  return weights;
}

}  // namespace waymark::pipeline

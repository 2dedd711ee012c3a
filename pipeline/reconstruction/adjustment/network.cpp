// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/network.hpp"

namespace waymark::pipeline {

std::size_t Network::add_block(Block::Kind kind, Eigen::VectorXd value, std::vector<int> free) {
  blocks.push_back({kind, std::move(value), std::move(free)});
  return blocks.size() - 1;
}

bool Network::linearize(const Term& term, Term::Linear& out) const {
  std::array<const double*, Term::kMaxBlocks> values{};
  for (std::size_t i = 0; i < term.blocks.size(); ++i) values[i] = blocks[term.blocks[i]].value.data();
  return term.linearize(values.data(), out);
}

void Network::number_columns() {
  camera_columns = point_columns = 0;
  for (Block& block : blocks) {
    Eigen::Index& next = block.kind == Block::Kind::point ? point_columns : camera_columns;
    block.column = block.free.empty() ? -1 : next;
    next += static_cast<Eigen::Index>(block.free.size());
  }
}

Eigen::Isometry3d pose_of(const double* block) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Map<const Eigen::Quaterniond>(block).normalized().toRotationMatrix();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(block + 4);
  return pose;
}

void apply_change(Block::Kind kind, const double* value, const double* change, Eigen::Index size,
                  double* out) {
  if (kind != Block::Kind::pose) {
    for (Eigen::Index i = 0; i < size; ++i) out[i] = value[i] + change[i];
    return;
  }
  const Eigen::Vector3d turn(change[0], change[1], change[2]);
  const double angle = turn.norm(), half = angle / 2;
  const double sine = angle > 1e-8 ? std::sin(half) / angle : 0.5;
  const Eigen::Quaterniond step(std::cos(half), sine * turn.x(), sine * turn.y(), sine * turn.z());
  const Eigen::Quaterniond turned = (Eigen::Map<const Eigen::Quaterniond>(value) * step).normalized();
  Eigen::Map<Eigen::Vector4d>{out} = turned.coeffs();
  for (int i = 0; i < 3; ++i) out[4 + i] = value[4 + i] + change[3 + i];
}

}  // namespace waymark::pipeline

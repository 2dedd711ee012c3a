// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/frame_tree.hpp"

namespace waymark::importers {

void FrameTree::place(const std::string& child, const std::string& parent,
                      const Eigen::Isometry3d& parent_from_child) {
  frames_.try_emplace(child, Placed{parent, parent_from_child});
}

std::optional<Eigen::Isometry3d> FrameTree::transform(const std::string& to, const std::string& from) const {
  if (to == from) return Eigen::Isometry3d::Identity();
  const Rooted a = rooted(to), b = rooted(from);
  if (a.root != b.root) return std::nullopt;
  return a.root_from_frame.inverse() * b.root_from_frame;
}

FrameTree::Rooted FrameTree::rooted(const std::string& frame) const {
  Rooted at{frame, Eigen::Isometry3d::Identity()};
  // The count of frames bounds the climb where damaged messages close a ring.
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const auto placed = frames_.find(at.root);
    if (placed == frames_.end()) break;
    at.root_from_frame = placed->second.parent_from_child * at.root_from_frame;
    at.root = placed->second.parent;
  }
  return at;
}

}  // namespace waymark::importers

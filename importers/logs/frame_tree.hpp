// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
namespace waymark::importers {

/// Frames of a robot, each placed in its parent (messages tf and tf_static of ROS). A frame keeps its first
/// place: between the body and a fixed sensor nothing moves.
class FrameTree {
 public:
  void place(const std::string& child, const std::string& parent, const Eigen::Isometry3d& parent_from_child);

  /// Returns to_from_from; `std::nullopt` if no chain joins the frames.
  std::optional<Eigen::Isometry3d> transform(const std::string& to, const std::string& from) const;

 private:
  struct Placed {
    std::string parent;
    Eigen::Isometry3d parent_from_child;
  };
  struct Rooted {
    std::string root;
    Eigen::Isometry3d root_from_frame;
  };
  Rooted rooted(const std::string& frame) const;

  std::map<std::string, Placed> frames_;
};

}  // namespace waymark::importers

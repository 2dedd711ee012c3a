// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/track_formats.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "core/atomic_file.hpp"

namespace waymark::exporters {
namespace {

// Rz(yaw) Ry(pitch) Rx(roll), as in logs.
Eigen::Quaterniond rotation_of(const localization::TrackRow& row) {
  return Eigen::AngleAxisd(row.at.pose.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(row.pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(row.roll, Eigen::Vector3d::UnitX());
}

std::string tum_row(const localization::TrackRow& row) {
  const Eigen::Quaterniond q = rotation_of(row);
  return fmt::format("{:.9f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", row.t, row.at.pose.x,
                     row.at.pose.y, row.z, q.x(), q.y(), q.z(), q.w());
}

std::string kitti_row(const localization::TrackRow& row) {
  const Eigen::Matrix3d r = rotation_of(row).toRotationMatrix();
  const double at[3] = {row.at.pose.x, row.at.pose.y, row.z};
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += fmt::format("{}{:.9f} {:.9f} {:.9f} {:.6f}", i > 0 ? " " : "", r(i, 0), r(i, 1), r(i, 2), at[i]);
  return text + '\n';
}

std::string g2o_rows(const localization::TrackRow& row, std::size_t id) {
  const localization::Pose2& p = row.at.pose;
  std::string text = fmt::format("VERTEX_SE2 {} {:.6f} {:.6f} {:.9f}\n", id, p.x, p.y, p.yaw);
  const Eigen::LLT<Eigen::Matrix3d> factor(row.at.covariance);
  if (factor.info() != Eigen::Success) return text;
  const Eigen::Matrix3d i = factor.solve(Eigen::Matrix3d::Identity());
  return text +
         fmt::format("EDGE_PRIOR_SE2 {} {:.6f} {:.6f} {:.9f} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", id,
                     p.x, p.y, p.yaw, i(0, 0), i(0, 1), i(0, 2), i(1, 1), i(1, 2), i(2, 2));
}

}  // namespace

void write_track_poses(const std::filesystem::path& file, const localization::Track& track,
                       TrackFormat format) {
  std::string text;
  for (std::size_t i = 0; i < track.rows.size(); ++i)
    text += format == TrackFormat::tum     ? tum_row(track.rows[i])
            : format == TrackFormat::kitti ? kitti_row(track.rows[i])
                                           : g2o_rows(track.rows[i], i);
  write_file(file, text);
}

}  // namespace waymark::exporters

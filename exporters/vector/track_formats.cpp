// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/track_formats.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"

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

bool begins_like_tum(std::string_view content) {
  const std::size_t first = content.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos &&
         std::string_view("#+-.0123456789").find(content[first]) != std::string_view::npos;
}

localization::Track read_track_tum(std::string_view content, const std::filesystem::path& file) {
  localization::Track track;
  std::istringstream in{std::string(content)};
  std::size_t number = 1;
  for (std::string line; std::getline(in, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> v;
    for (std::string word; words >> word;) {
      double value = 0;
      const auto [rest, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
      const bool is_number = problem == std::errc() && rest == word.data() + word.size();
      v.push_back(is_number ? value : std::nan(""));
    }
    if (v.empty()) continue;
    const bool finite = std::ranges::all_of(v, [](double one) { return std::isfinite(one); });
    const double length = v.size() == 8 ? Eigen::Vector4d(v[4], v[5], v[6], v[7]).norm() : 0;
    if (!finite || !(std::abs(length - 1) < 0.01) || !(std::abs(v[0]) <= 1e15))
      throw Error(ErrorCode::input, "this line is no pose of TUM",
                  fmt::format("{}, line {}", file.string(), number),
                  "eight numbers separated by blanks: t x y z qx qy qz qw, the quaternion of length 1");
    const Eigen::Matrix3d r = Eigen::Quaterniond(v[7], v[4], v[5], v[6]).normalized().toRotationMatrix();
    localization::TrackRow& row = track.rows.emplace_back();
    row.t = v[0], row.z = v[3];
    row.at.pose = {v[1], v[2], std::atan2(r(1, 0), r(0, 0))};
    row.pitch = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
    row.roll = std::atan2(r(2, 1), r(2, 2));
  }
  return track;
}

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

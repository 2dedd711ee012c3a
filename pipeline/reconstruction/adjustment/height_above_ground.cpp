// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/height_above_ground.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/reconstruction/adjustment/level_relief.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kPoints = 12, kMinPoints = 6;
constexpr double kMaxDistance = 0.2;  // of the nearest point, by the height of the camera above it

}  // namespace

std::optional<GroundBelow> ground_below(const Reconstruction& scene, std::size_t image) {
  const Eigen::Vector3d camera = scene.images[image].world_from_camera->translation();
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const TiePoint& point = scene.points[i];
    if (!point.position || point.marks.empty() ||
        scene.images[point.marks[0].image].component != scene.images[image].component)
      continue;
    near.emplace_back((point.position->head<2>() - camera.head<2>()).norm(), i);
  }
  if (near.size() < kMinPoints) return std::nullopt;
  const std::size_t count = std::min(kPoints, near.size());
  // By positions: the order of the input must not matter.
  const auto nearer = [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    return scene.points[a.second].position->z() < scene.points[b.second].position->z();
  };
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(), nearer);
  const double above = camera.z() - scene.points[near[0].second].position->z();
  if (!(above > 0 && near[0].first <= kMaxDistance * above)) return std::nullopt;
  std::vector<Eigen::Vector3d> points;  // about the nadir, reduced by the distance of the outermost
  const double size = near[count - 1].first;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d& p = *scene.points[near[k].second].position;
    points.emplace_back((p.x() - camera.x()) / size, (p.y() - camera.y()) / size, p.z() - camera.z());
  }
  const Eigen::Vector3d plane = fitted_plane(points);
  std::vector<double> off;
  for (const Eigen::Vector3d& p : points)
    off.push_back(std::abs(p.z() - plane.dot(Eigen::Vector3d(p.x(), p.y(), 1))));
  std::ranges::sort(off);
  // Relief between the points: one of them is as far off as the ground at the nadir may be.
  return GroundBelow{
      .height = camera.z() + plane.z(), .sd = 1.4826 * off[off.size() / 2], .point = near[0].second};
}

}  // namespace waymark::pipeline

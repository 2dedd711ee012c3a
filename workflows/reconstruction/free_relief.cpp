// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/free_relief.hpp"

namespace waymark::workflows {

std::vector<Eigen::Vector3d> tie_positions(const pipeline::Reconstruction& scene) {
  std::vector<Eigen::Vector3d> out;
  for (const pipeline::TiePoint& point : scene.points)
    if (point.position) out.push_back(*point.position);
  return out;
}

FreeRelief free_relief(const pipeline::Reconstruction& scene, const pipeline::Observations& seen) {
  FreeRelief out{.points = tie_positions(scene)};
  for (const pipeline::AdjustedImage& image : scene.images)
    if (image.world_from_camera) {
      if (out.centres.empty()) out.component = image.component;
      out.centres.push_back(image.world_from_camera->translation());
    }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const pipeline::ObservedUp& up : seen.ups)
    sum += scene.images[up.image].world_from_camera->linear() * up.up_in_camera;
  if (sum.norm() > 0.9 * double(seen.ups.size()) && !seen.ups.empty()) out.up = sum.normalized();
  return out;
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/surface_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {

std::vector<SurfaceView> surface_views(const ImageSet& images) {
  std::vector<SurfaceView> views;
  for (const ImageHandle& image : images) {
    const ImageInfo& info = image->info();
    if (info.view) views.push_back({.name = info.name, .view = *info.view, .sun = info.sun, .image = image});
  }
  std::ranges::sort(views, {}, &SurfaceView::name);
  return views;
}

double ground_sample_distance(const PosedCamera& view, const Eigen::Vector3d& point) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double step = 1e-4 * (view.centre().xyz - point).norm();
  const auto here = project(view, {point});
  const auto east = project(view, {point + Eigen::Vector3d(step, 0, 0)});
  const auto north = project(view, {point + Eigen::Vector3d(0, step, 0)});
  if (!here || !east || !north || !(step > 0)) return kNone;
  const Eigen::Vector2d a = (*east - *here) / step, b = (*north - *here) / step;
  const double area = std::abs(a.x() * b.y() - a.y() * b.x());
  return area > 0 ? 1 / std::sqrt(area) : kNone;
}

double convergence_angle(const PosedCamera& a, const PosedCamera& b, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = a.centre().xyz - point, q = b.centre().xyz - point;
  return std::atan2(p.cross(q).norm(), p.dot(q));
}

bool in_image(const Camera& camera, const Eigen::Vector2d& pixel, double margin) {
  return pixel.x() >= margin && pixel.y() >= margin &&
         pixel.x() <= static_cast<double>(camera.columns - 1) - margin &&
         pixel.y() <= static_cast<double>(camera.rows - 1) - margin;
}

}  // namespace waymark::pipeline

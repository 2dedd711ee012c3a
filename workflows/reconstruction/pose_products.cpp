// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_products.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "exporters/las_file.hpp"
#include "geo/crs.hpp"
#include "workflows/reconstruction/pose_summary.hpp"

namespace waymark::workflows {
namespace {

exporters::CameraFileContent camera_content(const PosedPhotos& posed, const Photos& photos) {
  exporters::CameraFileContent content;
  if (!posed.crs.empty()) content.crs = posed.crs;
  for (const pipeline::AdjustedLens& lens : posed.scene.lenses)
    content.lenses.push_back({lens.camera, lens.readout_time});
  for (std::size_t i = 0; i < posed.scene.images.size(); ++i) {
    const pipeline::AdjustedImage& image = posed.scene.images[i];
    content.images.push_back({.name = image.name,
                              .lens = image.lens,
                              .world_from_camera = image.world_from_camera,
                              .covariance = image.covariance,
                              .motion = image.motion,
                              .taken_utc = photos.photos[i].taken_utc});
  }
  return content;
}

void write_las(const std::filesystem::path& file, const std::string& crs_text,
               const std::vector<exporters::SparsePoint>& points) {
  if (points.empty()) return;
  const Crs crs = crs_text == "local" ? Crs::local() : Crs::from_text(crs_text);
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  const Eigen::Vector3d& first = points.front().position;
  exporters::LasFile las(file, crs, first.x() / unit, first.y() / unit);
  for (const exporters::SparsePoint& point : points)
    las.add({.x = point.position.x() / unit, .y = point.position.y() / unit, .z = point.position.z()});
  las.close();
}

}  // namespace

std::vector<exporters::SparsePoint> sparse_points(const pipeline::Reconstruction& scene) {
  std::vector<exporters::SparsePoint> points;
  for (const pipeline::TiePoint& tie : scene.points) {
    if (!tie.position) continue;
    exporters::SparsePoint point{.position = *tie.position};
    double squares = 0;
    for (const pipeline::Mark& m : tie.marks) {
      const auto residual = residual_of(scene, tie, m);
      if (!residual) continue;
      squares += residual->squaredNorm();
      point.marks.push_back({m.image, m.pixel});
    }
    if (point.marks.size() < 2) continue;
    point.error = std::sqrt(squares / double(2 * point.marks.size()));
    if (tie.covariance)
      point.sd = std::sqrt(tie.covariance->selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
    points.push_back(std::move(point));
  }
  return points;
}

void write_pose_products(const PosedPhotos& posed, const Photos& photos,
                         const std::vector<exporters::SparsePoint>& points,
                         const std::filesystem::path& folder) {
  const exporters::CameraFileContent content = camera_content(posed, photos);
  write_file(folder / "cameras.json", exporters::camera_file_text(content));
  write_file(folder / "points.ply", exporters::ply_text(points));
  if (!posed.crs.empty()) write_las(folder / "points.las", posed.crs, points);
  std::error_code failed;
  std::filesystem::create_directories(folder / "colmap", failed);
  if (failed) fail_output(folder / "colmap", failed.message());
  const exporters::ColmapModel model = exporters::colmap_model(content, points);
  write_file(folder / "colmap" / "cameras.txt", model.cameras);
  write_file(folder / "colmap" / "images.txt", model.images);
  write_file(folder / "colmap" / "points3D.txt", model.points);
}

}  // namespace waymark::workflows

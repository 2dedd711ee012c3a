// SPDX-License-Identifier: Apache-2.0
#include "exporters/cameras/camera_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace waymark::exporters {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson matrix_json(const Eigen::MatrixXd& m) {
  OrderedJson rows = OrderedJson::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    OrderedJson row = OrderedJson::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

OrderedJson lens_json(const CameraFileLens& from) {
  const Camera& camera = from.camera;
  std::size_t used = camera.distortion.size();
  while (used > 0 && camera.distortion[used - 1] == 0) --used;
  OrderedJson lens{{"columns", camera.columns}, {"rows", camera.rows}, {"fx", camera.fx},
                   {"fy", camera.fy},           {"cx", camera.cx},     {"cy", camera.cy}};
  if (camera.skew != 0) lens["skew"] = camera.skew;
  lens["lens"] = camera.lens == Camera::Lens::fisheye ? "fisheye" : "brown";
  lens["distortion"] = std::vector<double>(camera.distortion.begin(),
                                           camera.distortion.begin() + static_cast<std::ptrdiff_t>(used));
  if (from.readout_time > 0) lens["readout_time"] = from.readout_time;
  return lens;
}

OrderedJson vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::string lens_name(std::size_t index) {
  return fmt::format("lens_{}", index + 1);
}

std::string colmap_camera(std::size_t index, const Camera& c) {
  const auto& d = c.distortion;
  const std::string start = fmt::format("{} {} {} {} {} {} {} {}", index + 1,
                                        c.lens == Camera::Lens::fisheye ? "OPENCV_FISHEYE" : "FULL_OPENCV",
                                        c.columns, c.rows, c.fx, c.fy, c.cx + 0.5, c.cy + 0.5);
  const std::size_t count = c.lens == Camera::Lens::fisheye ? 4 : 8;
  std::string line = start;
  for (std::size_t k = 0; k < count; ++k) line += fmt::format(" {}", d[k]);
  return line + "\n";
}

}  // namespace

std::string camera_file_text(const CameraFileContent& content) {
  OrderedJson file{{"waymark_cameras", 1}};
  if (content.crs)
    file["frame"] = {{"axes", "grid"}, {"crs", *content.crs}};
  else
    file["frame"] = {{"axes", "arbitrary"}};
  file["cameras"] = OrderedJson::object();
  for (std::size_t i = 0; i < content.lenses.size(); ++i)
    file["cameras"][lens_name(i)] = lens_json(content.lenses[i]);
  file["images"] = OrderedJson::array();
  for (const CameraFileImage& image : content.images) {
    OrderedJson entry{{"name", image.name}, {"camera", lens_name(image.lens)}};
    if (const auto& pose = image.world_from_camera) {
      entry["centre"] = vector_json(pose->translation());
      entry["rotation"] = matrix_json(pose->linear());
      if (image.covariance) entry["covariance"] = matrix_json(*image.covariance);
      if (const auto& motion = image.motion)
        entry["motion"] = {{"shift", vector_json(motion->shift)}, {"turn", vector_json(motion->turn)}};
    }
    if (image.sun)
      entry["sun"] = {{"azimuth", image.sun->azimuth.value},
                      {"elevation", image.sun->elevation.value},
                      {"sd", image.sun->sd.value}};
    if (!image.taken_utc.empty()) entry["taken_utc"] = image.taken_utc;
    file["images"].push_back(std::move(entry));
  }
  return file.dump(1, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

ColmapModel colmap_model(const CameraFileContent& content, const std::vector<SparsePoint>& points) {
  ColmapModel out;
  for (std::size_t i = 0; i < content.lenses.size(); ++i)
    out.cameras += colmap_camera(i, content.lenses[i].camera);
  std::vector<std::string> marks(content.images.size());
  std::vector<std::size_t> counts(content.images.size(), 0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const SparsePoint& point = points[p];
    const Eigen::Vector3d& at = point.position;
    out.points += fmt::format("{} {} {} {} 128 128 128 {}", p + 1, at.x(), at.y(), at.z(), point.error);
    for (const SparsePoint::SeenIn& seen : point.marks) {
      if (!content.images[seen.image].world_from_camera) continue;
      out.points += fmt::format(" {} {}", seen.image + 1, counts[seen.image]++);
      marks[seen.image] += fmt::format("{}{} {} {}", marks[seen.image].empty() ? "" : " ",
                                       seen.pixel.x() + 0.5, seen.pixel.y() + 0.5, p + 1);
    }
    out.points += "\n";
  }
  for (std::size_t i = 0; i < content.images.size(); ++i) {
    const CameraFileImage& image = content.images[i];
    if (!image.world_from_camera) continue;
    const Eigen::Isometry3d inverse = image.world_from_camera->inverse();
    const Eigen::Quaterniond q(inverse.linear());
    const Eigen::Vector3d t = inverse.translation();
    out.images += fmt::format("{} {} {} {} {} {} {} {} {} {}\n{}\n", i + 1, q.w(), q.x(), q.y(), q.z(), t.x(),
                              t.y(), t.z(), image.lens + 1, image.name, marks[i]);
  }
  return out;
}

std::string ply_text(const std::vector<SparsePoint>& points) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property float sd\nproperty int images\nend_header\n",
      points.size());
  for (const SparsePoint& p : points)
    text += fmt::format("{:.4f} {:.4f} {:.4f} {:.4g} {}\n", p.position.x(), p.position.y(), p.position.z(),
                        p.sd, p.marks.size());
  return text;
}

}  // namespace waymark::exporters

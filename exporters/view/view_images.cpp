// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_images.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/json_text.hpp"
#include "exporters/report/image_picture.hpp"
#include "exporters/report/image_section.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

using CameraJson = nlohmann::json;
constexpr int kEdgePoints = 8;  // rays per side of an image's border

/// Reads the camera of an image record (pipeline/fusion/projection/image_view.cpp); `std::nullopt` for
/// orthophotos and anything that is not such a camera.
std::optional<PosedCamera> parse_camera(const std::string& text) try {
  const CameraJson json = CameraJson::parse(json_or_empty(text));
  const std::string model = json.value("model", "");
  if (model != "brown" && model != "fisheye") return {};
  PosedCamera view;
  Camera& camera = view.camera;
  camera.lens = model == "fisheye" ? Camera::Lens::fisheye : Camera::Lens::brown;
  camera.columns = json.at("columns").get<std::int64_t>();
  camera.rows = json.at("rows").get<std::int64_t>();
  camera.fx = json.at("focal").at(0).get<double>();
  camera.fy = json.at("focal").at(1).get<double>();
  camera.cx = json.at("principal_point").at(0).get<double>();
  camera.cy = json.at("principal_point").at(1).get<double>();
  camera.skew = json.value("skew", 0.0);
  camera.distortion = json.at("distortion").get<std::array<double, 8>>();
  for (int r = 0; r < 3; ++r) {
    view.grid_from_camera.transform.translation()(r) =
        json.at("centre").at(static_cast<std::size_t>(r)).get<double>();
    for (int c = 0; c < 3; ++c)
      view.grid_from_camera.transform.linear()(r, c) = json.at("grid_from_camera")
                                                           .at(static_cast<std::size_t>(r))
                                                           .at(static_cast<std::size_t>(c))
                                                           .get<double>();
  }
  const bool sound = camera.columns > 0 && camera.rows > 0 && camera.fx > 0 && camera.fy > 0 &&
                     view.grid_from_camera.transform.matrix().allFinite();
  return sound ? std::optional(view) : std::nullopt;
} catch (const CameraJson::exception&) {
  return {};
}

/// Returns pixels along the edge of an image, clockwise from the upper left corner.
std::vector<Eigen::Vector2d> edge_pixels(const Camera& camera) {
  const double right = double(camera.columns) - 0.5, bottom = double(camera.rows) - 0.5;
  const Eigen::Vector2d corners[] = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
  std::vector<Eigen::Vector2d> pixels;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < kEdgePoints; ++i)
      pixels.push_back(corners[side] + (corners[(side + 1) % 4] - corners[side]) * i / kEdgePoints);
  return pixels;
}

ViewImage view_image(const PosedImageFile& file, const ViewFrame& frame, std::int64_t pixels) {
  const Camera& camera = file.view.camera;
  ViewImage view{.name = file.name, .jpeg = {}, .columns = camera.columns, .rows = camera.rows, .border = {}};
  const double unit = frame.crs().kind() == CrsKind::projected ? frame.crs().metres_per_unit() : 1;
  Eigen::Vector3d centre = file.view.centre().xyz;
  centre.head<2>() /= unit;
  view.centre = frame.from_crs({centre});
  view.frame_from_camera = frame.rotation_from_grid({centre}) * file.view.grid_from_camera.transform.linear();
  view.lens = {camera.fx, camera.fy, camera.cx, camera.cy, camera.skew};
  view.distortion = camera.distortion;
  view.is_fisheye = camera.lens == Camera::Lens::fisheye;
  for (const Eigen::Vector2d& pixel : edge_pixels(camera))
    if (const auto seen = ray(camera, pixel); seen && seen->unit.z() > 0) {
      view.max_radius =
          std::max(view.max_radius, seen->unit.head<2>().norm() / std::max(seen->unit.z(), 1e-3));
      view.border.push_back(view.frame_from_camera * seen->unit);
    }
  if (const auto extent = file.path.empty() ? std::nullopt : image_extent(file.path))
    if (auto picture = image_picture(file.path, *extent, pixels)) view.jpeg = std::move(picture->jpeg);
  return view;
}

}  // namespace

std::vector<PosedImageFile> posed_images(const geodb::MapStore& map) {
  std::vector<PosedImageFile> images;
  for (const geodb::ImageRecord& record : map.images())
    if (const auto view = parse_camera(record.camera_json))
      images.push_back({record.name, find_image_file(map, record.name).value_or(""), *view});
  return images;
}

std::vector<ViewImage> make_view_images(const std::vector<PosedImageFile>& images, const ViewFrame& frame,
                                        std::size_t max_images, std::int64_t pixels) {
  std::vector<ViewImage> views;
  const std::size_t shown = std::min(images.size(), max_images);
  for (std::size_t i = 0; i < shown; ++i)
    views.push_back(view_image(images[shown < 2 ? 0 : i * (images.size() - 1) / (shown - 1)], frame, pixels));
  return views;
}

}  // namespace waymark::exporters

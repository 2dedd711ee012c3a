// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/image_view.hpp"

#include <nlohmann/json.hpp>

namespace waymark::pipeline {
namespace {

nlohmann::json as_json(const PosedCamera& view) {
  const Camera& c = view.camera;
  nlohmann::json rotation = nlohmann::json::array();
  for (int r = 0; r < 3; ++r) {
    const Eigen::Vector3d row = view.grid_from_camera.transform.linear().row(r);
    rotation.push_back({row.x(), row.y(), row.z()});
  }
  const Eigen::Vector3d at = view.centre().xyz;
  nlohmann::json json{{"model", c.lens == Camera::Lens::fisheye ? "fisheye" : "brown"},
                      {"columns", c.columns},
                      {"rows", c.rows},
                      {"focal", {c.fx, c.fy}},
                      {"principal_point", {c.cx, c.cy}},
                      {"skew", c.skew},
                      {"distortion", c.distortion},
                      {"centre", {at.x(), at.y(), at.z()}},
                      {"grid_from_camera", rotation}};
  if (const auto& m = view.motion)
    json["motion"] = {{"shift", {m->shift.x(), m->shift.y(), m->shift.z()}},
                      {"turn", {m->turn.x(), m->turn.y(), m->turn.z()}}};
  return json;
}

nlohmann::json as_json(const OrthoGrid& ortho) {
  return {{"model", "ortho"}, {"first_pixel", {ortho.x0, ortho.y0}}, {"step", {ortho.step_x, ortho.step_y}}};
}

}  // namespace

std::string camera_json(const ImageView& image) {
  if (image.view) return as_json(*image.view).dump();
  if (image.ortho) return as_json(*image.ortho).dump();
  return "{}";
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>
#include "pipeline/reconstruction/surface/surface_view.hpp"
#include "testbed/landing/lit_terrain.hpp"
#include "testbed/render.hpp"
namespace waymark::test {

/// An image in memory.
class MadeImage : public ImageSource {
 public:
  MadeImage(ImageInfo info, Pixels pixels) : info_(std::move(info)), pixels_(std::move(pixels)) {}
  const ImageInfo& info() const override { return info_; }
  Pixels read(const Window& w) const override {
    Pixels out(w.columns, w.rows);
    for (std::int64_t r = 0; r < w.rows; ++r)
      for (std::int64_t c = 0; c < w.columns; ++c) out(c, r) = pixels_(w.column + c, w.row + r);
    return out;
  }

 private:
  ImageInfo info_;
  Pixels pixels_;
};

/// A camera of 160 x 160 pixels and 60 degrees that looks straight down, its upper edge to the north.
inline PosedCamera camera_above(double x, double y, double z) {
  PosedCamera view;
  view.camera = {.columns = 160, .rows = 160, .fx = 140, .fy = 140, .cx = 79.5, .cy = 79.5};
  view.grid_from_camera.transform.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  view.grid_from_camera.transform.translation() = Eigen::Vector3d(x, y, z);
  return view;
}

inline pipeline::SurfaceView made_view(const std::string& name, const PosedCamera& camera, Pixels pixels) {
  ImageInfo info;
  info.name = info.path = name;
  info.columns = camera.camera.columns;
  info.rows = camera.camera.rows;
  info.view = camera;
  return {.name = name, .view = camera, .image = std::make_shared<MadeImage>(info, std::move(pixels))};
}

/// A small cratered site without rocks, whose terrain is exactly what the images see.
inline testbed::Scene made_site(std::uint64_t seed) {
  testbed::SiteModel ground;
  ground.cell = 0.4;
  ground.width = ground.height = 150;
  ground.relief.rms = 2;
  ground.relief.longest = 80;
  ground.craters.max_diameter = 30;
  ground.rocks.k = 0;
  return testbed::make_scene(ground, seed);
}

/// Views from 60 m: a cross of five, 14 m apart. GSD 0.43 m, angles up to 25 degrees. With a readout time the
/// cameras move and turn by up to 4 px meanwhile, each in its own direction.
inline std::vector<pipeline::SurfaceView> made_flight(const testbed::Scene& scene, double readout_time = 0) {
  testbed::Exposure exposure;
  exposure.readout_time = readout_time;
  const testbed::LitTerrain lit(scene, exposure.sun);
  std::vector<pipeline::SurfaceView> views;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {-14.0, 0.0}, {14.0, 0.0}, {0.0, -14.0}, {0.0, 14.0}}) {
    PosedCamera camera = camera_above(x, y, 60);
    const double phase = double(views.size());
    const testbed::CameraMotion motion{
        .velocity = 15 * Eigen::Vector3d(std::cos(2 * phase), std::sin(2 * phase), 0.2),
        .spin = 0.2 * Eigen::Vector3d(std::sin(3 * phase), std::cos(3 * phase), 1)};
    Pixels image =
        testbed::render_view(scene, lit, testbed::camera_view(camera, motion), exposure, views.size());
    if (readout_time > 0)
      camera.motion = {
          .shift = readout_time * motion.velocity,
          .turn = readout_time * camera.grid_from_camera.transform.linear().transpose() * motion.spin};
    for (float& value : image.cells()) value *= 255;
    views.push_back(made_view("view_" + std::to_string(views.size()), camera, std::move(image)));
  }
  return views;
}

}  // namespace waymark::test

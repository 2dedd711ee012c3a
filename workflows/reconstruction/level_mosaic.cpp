// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/level_mosaic.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/median.hpp"
#include "importers/images/image_set.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "workflows/reconstruction/free_relief.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kMosaicCells = 160, kGroundCells = 48;  // across
constexpr double kMinSine = 0.7;  // of the elevation of a camera above the ground that it shows as a map does

// Median heights of points by cells; cells without points are filled from their surroundings.
Grid<float> heights_of(const std::vector<Eigen::Vector3d>& points, const pipeline::SurfaceGrid& grid) {
  Grid<std::vector<double>> cells(grid.columns, grid.rows);
  for (const Eigen::Vector3d& p : points) {
    const std::int64_t c = std::llround(grid.column(p.x())), r = std::llround(grid.row(p.y()));
    if (cells.contains(c, r)) cells(c, r).push_back(p.z());
  }
  Grid<float> out(grid.columns, grid.rows, std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t r = 0; r < grid.rows; ++r)
    for (std::int64_t c = 0; c < grid.columns; ++c)
      if (!cells(c, r).empty()) out(c, r) = static_cast<float>(median(std::move(cells(c, r))));
  return pipeline::fill_gaps(pipeline::median_filter(out));
}

// Square about points in plan, without the outermost hundredth.
pipeline::SurfaceGrid square_about(const std::vector<Eigen::Vector3d>& points, std::int64_t cells) {
  std::vector<double> x, y;
  for (const Eigen::Vector3d& p : points) x.push_back(p.x()), y.push_back(p.y());
  if (points.empty()) return {.cell = 1, .columns = cells, .rows = cells};
  std::ranges::sort(x), std::ranges::sort(y);
  const std::size_t low = x.size() / 100, high = x.size() - 1 - low;
  const double side = std::max(x[high] - x[low], y[high] - y[low]);
  return {.west = (x[low] + x[high] - side) / 2,
          .north = (y[low] + y[high] + side) / 2,
          .cell = side / double(cells),
          .columns = cells,
          .rows = cells};
}

// Whether a view sees a point steeply enough to show it as a map does.
bool sees_from_above(const pipeline::SurfaceView& view, const Eigen::Vector3d& point) {
  const auto pixel = project(view.view, {point});
  return pixel && pipeline::in_image(view.view.camera, *pixel, 1) &&
         (view.view.centre().xyz - point).normalized().z() > kMinSine;
}

}  // namespace

SceneViews views_of(const pipeline::Reconstruction& scene, const Photos& photos) {
  SceneViews out;
  std::vector<ImageInfo> infos;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const pipeline::AdjustedImage& image = scene.images[i];
    if (!image.world_from_camera) continue;
    const Camera& camera = scene.lenses[image.lens].camera;
    ImageInfo info;
    info.name = image.name;
    info.path = photos.photos[i].path;
    info.columns = camera.columns, info.rows = camera.rows;
    info.view.emplace();
    info.view->camera = camera;
    info.view->grid_from_camera.transform = *image.world_from_camera;
    info.view->motion = image.motion;
    info.saturated = photos.photos[i].saturated;
    infos.push_back(std::move(info));
    out.images.push_back(i);
  }
  const ImageSet handles = importers::image_set(infos);
  for (std::size_t v = 0; v < infos.size(); ++v)
    out.views.push_back({.name = infos[v].name, .view = *infos[v].view, .image = handles[v]});
  return out;
}

pipeline::CoarseHeights ground_of(const pipeline::Reconstruction& scene) {
  const std::vector<Eigen::Vector3d> points = tie_positions(scene);
  pipeline::CoarseHeights out{.grid = square_about(points, kGroundCells)};
  out.heights = heights_of(points, out.grid);
  return out;
}

pipeline::LevelImage level_mosaic(const pipeline::Reconstruction& scene, const Photos& photos) {
  const std::vector<Eigen::Vector3d> points = tie_positions(scene);
  const std::vector<pipeline::SurfaceView> views = views_of(scene, photos).views;
  std::vector<Eigen::Vector3d> seen;
  std::ranges::copy_if(points, std::back_inserter(seen), [&](const Eigen::Vector3d& p) {
    return std::ranges::any_of(views, [&](const auto& view) { return sees_from_above(view, p); });
  });
  pipeline::LevelImage out{.grid = square_about(seen, kMosaicCells)};
  const pipeline::SurfaceGrid coarse =
      out.grid.with_cell(out.grid.cell * double(kMosaicCells) / double(kGroundCells));
  const Grid<float> heights = pipeline::resample(heights_of(points, coarse), coarse, out.grid);
  pipeline::Orthophoto mosaic = pipeline::make_orthophoto(views, out.grid, heights, 1, kViewBytes);
  out.brightness = std::move(mosaic.brightness);
  for (std::int64_t r = 0; r < out.grid.rows; ++r)
    for (std::int64_t c = 0; c < out.grid.columns; ++c) {
      const Eigen::Vector3d at(out.grid.x(double(c)), out.grid.y(double(r)), double(heights(c, r)));
      const std::size_t source = mosaic.source(c, r);
      if (source == 0 || !sees_from_above(views[source - 1], at))
        out.brightness(c, r) = std::numeric_limits<float>::quiet_NaN();
    }
  return out;
}

}  // namespace waymark::workflows

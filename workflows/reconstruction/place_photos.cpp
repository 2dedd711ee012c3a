// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/place_photos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/median.hpp"
#include "importers/images/image_set.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/level_relief.hpp"
#include "pipeline/reconstruction/adjustment/map_image_control.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "workflows/reconstruction/coarse_dem.hpp"
#include "workflows/reconstruction/map_image.hpp"
#include "workflows/reconstruction/posed_images.hpp"

namespace waymark::workflows {
namespace {

constexpr std::size_t kMosaicBytes = std::size_t{1} << 29;
constexpr std::int64_t kMosaicCells = 160, kGroundCells = 48;  // across
constexpr double kMinSine = 0.7;  // of the elevation of a camera above the ground of the mosaic
constexpr double kSlopeSd = std::numbers::pi / 180;  // of terrain taken as level, radians
constexpr double kDisplacement =
    0.1;  // of what is higher in an orthophoto, by its height: a view 6 degrees off

/// Posed images of a reconstruction as views, and which image each is.
struct SceneViews {
  std::vector<pipeline::SurfaceView> views = {};
  std::vector<std::size_t> images = {};
};

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
    info.saturated = photos.photos[i].saturated;
    infos.push_back(std::move(info));
    out.images.push_back(i);
  }
  const ImageSet handles = importers::image_set(infos);
  for (std::size_t v = 0; v < infos.size(); ++v)
    out.views.push_back({.name = infos[v].name, .view = *infos[v].view, .image = handles[v]});
  return out;
}

std::vector<Eigen::Vector3d> points_of(const pipeline::Reconstruction& scene) {
  std::vector<Eigen::Vector3d> points;
  for (const pipeline::TiePoint& point : scene.points)
    if (point.position) points.push_back(*point.position);
  return points;
}

// Median heights of points by cells; cells without points are filled from their surroundings.
Grid<float> heights_of(const std::vector<Eigen::Vector3d>& points, const pipeline::SurfaceGrid& grid) {
  Grid<std::vector<float>> cells(grid.columns, grid.rows);
  for (const Eigen::Vector3d& p : points) {
    const std::int64_t c = std::llround(grid.column(p.x())), r = std::llround(grid.row(p.y()));
    if (cells.contains(c, r)) cells(c, r).push_back(static_cast<float>(p.z()));
  }
  Grid<float> out(grid.columns, grid.rows, std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t r = 0; r < grid.rows; ++r)
    for (std::int64_t c = 0; c < grid.columns; ++c)
      if (std::vector<float>& here = cells(c, r); !here.empty()) {
        const auto middle = here.begin() + static_cast<std::ptrdiff_t>(here.size() / 2);
        std::nth_element(here.begin(), middle, here.end());
        out(c, r) = *middle;
      }
  return pipeline::fill_gaps(pipeline::median_filter(out));
}

pipeline::SurfaceGrid square_grid(const Eigen::Vector2d& middle, double side, std::int64_t cells) {
  return {.west = middle.x() - side / 2,
          .north = middle.y() + side / 2,
          .cell = side / double(cells),
          .columns = cells,
          .rows = cells};
}

std::size_t component_of(const pipeline::Reconstruction& scene) {
  for (const pipeline::AdjustedImage& image : scene.images)
    if (image.world_from_camera) return image.component;
  return 0;
}

// Whether a view sees a point steeply enough to show it as a map does.
bool sees_from_above(const pipeline::SurfaceView& view, const Eigen::Vector3d& point) {
  const auto pixel = project(view.view, {point});
  return pixel && pipeline::in_image(view.view.camera, *pixel, 1) &&
         (view.view.centre().xyz - point).normalized().z() > kMinSine;
}

// Square about the points of a level scene that are seen from above, without the outermost hundredth.
pipeline::SurfaceGrid mosaic_grid(const std::vector<Eigen::Vector3d>& points,
                                  const std::vector<pipeline::SurfaceView>& views) {
  std::vector<double> x, y;
  for (const Eigen::Vector3d& p : points)
    if (std::ranges::any_of(views, [&](const auto& view) { return sees_from_above(view, p); }))
      x.push_back(p.x()), y.push_back(p.y());
  if (x.size() < 3) return square_grid({0, 0}, 1000, kMosaicCells);
  std::ranges::sort(x), std::ranges::sort(y);
  const std::size_t low = x.size() / 100, high = x.size() - 1 - low;
  return square_grid({(x[low] + x[high]) / 2, (y[low] + y[high]) / 2},
                     std::max(x[high] - x[low], y[high] - y[low]), kMosaicCells);
}

// Mosaic of what the images of a level scene show from above.
pipeline::LevelImage level_mosaic(const pipeline::Reconstruction& scene, const Photos& photos) {
  const std::vector<Eigen::Vector3d> points = points_of(scene);
  const std::vector<pipeline::SurfaceView> views = views_of(scene, photos).views;
  pipeline::LevelImage out{.grid = mosaic_grid(points, views)};
  const pipeline::SurfaceGrid coarse =
      out.grid.with_cell(out.grid.cell * double(kMosaicCells) / double(kGroundCells));
  const Grid<float> heights = pipeline::resample(heights_of(points, coarse), coarse, out.grid);
  pipeline::Orthophoto mosaic = pipeline::make_orthophoto(views, out.grid, heights, 1, kMosaicBytes);
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

Similarity level_frame(const pipeline::Reconstruction& scene, const pipeline::Observations& seen) {
  std::vector<Eigen::Vector3d> centres;
  for (const pipeline::AdjustedImage& image : scene.images)
    if (image.world_from_camera) centres.push_back(image.world_from_camera->translation());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const pipeline::ObservedUp& up : seen.ups)
    sum += scene.images[up.image].world_from_camera->linear() * up.up_in_camera;
  const std::vector<Eigen::Vector3d> points = points_of(scene);
  pipeline::ReliefToPlace relief{.points = points, .centres = centres};
  if (!seen.ups.empty() && sum.norm() > 0.9 * double(seen.ups.size())) relief.up = sum.normalized();
  Similarity level = pipeline::level_relief(relief).level_from_frame;
  level.scale *= 1000, level.shift *= 1000;
  return level;
}

/// Ground that the tie points show, in the frame of the map.
pipeline::CoarseHeights ground_of(const pipeline::Reconstruction& scene) {
  const std::vector<Eigen::Vector3d> points = points_of(scene);
  std::vector<double> x, y;
  for (const Eigen::Vector3d& p : points) x.push_back(p.x()), y.push_back(p.y());
  std::ranges::sort(x), std::ranges::sort(y);
  const std::size_t low = x.size() / 100, high = x.size() - 1 - low;
  pipeline::CoarseHeights out{.grid =
                                  square_grid({(x[low] + x[high]) / 2, (y[low] + y[high]) / 2},
                                              std::max(x[high] - x[low], y[high] - y[low]), kGroundCells)};
  out.heights = heights_of(points, out.grid);
  return out;
}

/// Heights that control points of the map image get.
struct ControlHeights {
  std::optional<CoarseDem> dem = {};  // none: level terrain

  // Returns by how much the DEM is above the tie points.
  std::vector<double> differences(const pipeline::Reconstruction& scene) const {
    std::vector<double> out;
    for (const Eigen::Vector3d& p : points_of(scene))
      if (const double h = dem->height(p.x(), p.y()); std::isfinite(h)) out.push_back(h - p.z());
    return out;
  }
};

// A standard deviation that all points share, as one of each of `count` points of which `independent` are
// independent.
double shared_sd(double sd, double count, double independent) {
  return sd * std::sqrt(count / std::clamp(independent, 1.0, count));
}

// Gives the points heights of the DEM, or level ones. What they have in common limits what all of them say:
// the deviation of the DEM within its cells, the slope that terrain may have, and the displacement of what is
// higher or lower in an orthophoto that was made with a smooth DEM.
void set_heights(std::vector<pipeline::ControlPoint>& points, const ControlHeights& heights,
                 const pipeline::Reconstruction& scene, const pipeline::CoarseHeights& ground) {
  const double extent = ground.grid.cell * double(ground.grid.columns), count = double(points.size());
  double sd = shared_sd(kSlopeSd * extent / std::sqrt(12), count, 1);
  if (heights.dem) {
    std::vector<double> off = heights.differences(scene);
    for (double& d : off) d = std::abs(d);
    const double across = extent / heights.dem->cell(points[0].position.x(), points[0].position.y());
    sd = shared_sd(std::max(1.4826 * median(std::move(off)), ground.sd), count, across * across);
  }
  std::vector<double> levels;
  for (const pipeline::ControlPoint& point : points) levels.push_back(point.position.z());
  const double level = median(levels);
  for (pipeline::ControlPoint& point : points) {
    const double displaced = shared_sd(kDisplacement * std::abs(point.position.z() - level), count, 1);
    for (int i : {0, 1}) point.sd[i] = std::hypot(point.sd[i], displaced);
    const double height = heights.dem ? heights.dem->height(point.position.x(), point.position.y()) : 0;
    if (std::isfinite(height)) point.position.z() = height;
    point.sd.z() = std::isfinite(height) ? sd : std::numeric_limits<double>::infinity();
  }
}

// Covariances are scaled by the sigma0 of all observations, which is that of the many tie marks: deviations
// of the map are stated in its unit.
void divide_deviations(std::vector<pipeline::ControlPoint>& points, double sigma0) {
  if (!(sigma0 > 0)) return;
  for (pipeline::ControlPoint& point : points) {
    point.sd /= sigma0;
    for (pipeline::Mark& mark : point.marks) mark.sd /= sigma0;
  }
}

double rms_of(const std::vector<pipeline::ControlResult>& control) {
  double squares = 0, used = 0;
  for (const pipeline::ControlResult& point : control)
    if (point.used) squares += point.error.head<2>().squaredNorm(), ++used;
  return used > 0 ? std::sqrt(squares / used) : 0;
}

}  // namespace

void place_photos_in_image(PosedPhotos& posed, const Photos& photos, const pipeline::Observations& seen,
                           const std::vector<std::vector<std::string>>& free_lens_parameters,
                           const PosePhotosRequest& request) {
  const MapImage map = read_map_image(request.map_image, request.crs);
  for (const std::string& message : map.messages) posed.messages.push_back(message);
  pipeline::Reconstruction moved = posed.scene;
  const std::size_t component = component_of(moved);
  pipeline::transform(moved, component, level_frame(moved, seen));
  const pipeline::ImagePlacementResult placed =
      pipeline::place_on_image(level_mosaic(moved, photos), map.image);
  if (!placed.found) {
    posed.messages.push_back("the frame is arbitrary: " + placed.message +
                             "; control points or GPS positions give it for certain");
    return;
  }
  pipeline::transform(moved, component, placed.found->map_from_mosaic);
  moved.frame = pipeline::ReconstructionFrame::metric;
  ControlHeights heights;
  if (!request.dem.empty()) {
    heights.dem.emplace(request.dem, map.crs);
    pipeline::transform(moved, component, {.shift = {0, 0, median(heights.differences(moved))}});
  }
  pipeline::Georeferenced result;
  pipeline::MapImageControl control;
  for (const int reach : {10, 5}) {  // cells of the map; the second search starts at adjusted poses
    const pipeline::CoarseHeights ground = ground_of(moved);
    const SceneViews scene = views_of(moved, photos);
    pipeline::ImageLevels images(scene.views, kMosaicBytes);
    control = pipeline::control_of_map_image(map.image, ground, scene.views, scene.images, images,
                                             {.reach = reach});
    if (control.points.size() < 6) {
      posed.messages.push_back(
          fmt::format("the frame is arbitrary: the map image correlates by {:.2f}, but only {} of {} points "
                      "of it are found in "
                      "the images; control points or GPS positions give it for certain",
                      placed.found->score, control.points.size(), control.tried));
      return;
    }
    set_heights(control.points, heights, moved, ground);
    divide_deviations(control.points, posed.scene.sigma0);
    pipeline::Observations all = seen;
    all.control = control.points;
    result = pipeline::georeference(moved, all, {.free_lens_parameters = free_lens_parameters});
    if (!result.metric) {
      for (const std::string& message : result.messages) posed.messages.push_back(message);
      return;
    }
  }
  posed.scene = std::move(moved);
  posed.crs = text_of_crs(map.crs);
  posed.control = result.adjustment.control;
  posed.messages.push_back(
      fmt::format("placed in the map image: correlation {:.2f}, the next best place {:.2f}; {} points of the "
                  "map in {} places of "
                  "images, residuals {:.3g} m in plan",
                  placed.found->score, placed.found->next_best_score, control.points.size(), control.agreeing,
                  rms_of(posed.control)));
  if (!heights.dem)
    posed.messages.push_back(
        "heights are above the mean level of the terrain, taken as level within 1 degree; --dem gives them");
}

}  // namespace waymark::workflows

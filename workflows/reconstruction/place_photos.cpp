// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/place_photos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/median.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/level_relief.hpp"
#include "pipeline/reconstruction/adjustment/map_image_control.hpp"
#include "workflows/reconstruction/coarse_dem.hpp"
#include "workflows/reconstruction/free_relief.hpp"
#include "workflows/reconstruction/level_mosaic.hpp"
#include "workflows/reconstruction/map_image.hpp"
#include "workflows/reconstruction/posed_images.hpp"

namespace waymark::workflows {
namespace {

constexpr double kSlopeSd = std::numbers::pi / 180;  // of terrain taken as level, radians
constexpr double kDisplacement =
    0.1;  // of what is higher in an orthophoto, by its height: a view 6 degrees off

/// Heights that control points of the map image get.
struct ControlHeights {
  std::optional<CoarseDem> dem = {};  // none: level terrain

  // Returns by how much the DEM is above the tie points.
  std::vector<double> differences(const pipeline::Reconstruction& scene) const {
    std::vector<double> out;
    for (const Eigen::Vector3d& p : tie_positions(scene))
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
  const FreeRelief relief = free_relief(moved, seen);
  pipeline::transform(moved, relief.component, pipeline::level_relief(relief.view()).level_from_frame);
  const pipeline::ImagePlacementResult placed =
      pipeline::place_on_image(level_mosaic(moved, photos), map.image);
  if (!placed.found) {
    posed.messages.push_back("the frame is arbitrary: " + placed.message +
                             "; control points or GPS positions give it for certain");
    return;
  }
  pipeline::transform(moved, relief.component, placed.found->map_from_mosaic);
  moved.frame = pipeline::ReconstructionFrame::metric;
  ControlHeights heights;
  if (!request.dem.empty()) {
    heights.dem.emplace(request.dem, map.crs);
    pipeline::transform(moved, relief.component, {.shift = {0, 0, median(heights.differences(moved))}});
  }
  pipeline::Georeferenced result;
  pipeline::MapImageControl control;
  for (const int reach : {10, 5}) {  // cells of the map; the second search starts at adjusted poses
    const pipeline::CoarseHeights ground = ground_of(moved);
    const SceneViews scene = views_of(moved, photos);
    pipeline::ImageLevels images(scene.views, kViewBytes);
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

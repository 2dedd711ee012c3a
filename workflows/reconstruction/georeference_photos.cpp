// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/georeference_photos.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pipeline/reconstruction/adjustment/frame_by_heights.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"
#include "pipeline/reconstruction/adjustment/residual_correlation.hpp"
#include "workflows/reconstruction/coarse_dem.hpp"
#include "workflows/reconstruction/free_relief.hpp"
#include "workflows/reconstruction/photo_priors.hpp"
#include "workflows/reconstruction/place_photos.hpp"

namespace waymark::workflows {
namespace {

// Names of the lens parameters that the adjustment may free: none of a lens that is given.
std::vector<std::vector<std::string>> admitted_parameters(const PosedPhotos& posed) {
  std::vector<std::vector<std::string>> free(posed.scene.lenses.size());
  for (const pipeline::LadderStep& step : posed.ladder)
    if (step.admitted) free[step.lens].push_back(step.parameter);
  return free;
}

/// References of the pictures, and the CRS they are in.
struct PhotoReferences {
  std::string crs = {};
  pipeline::Observations seen = {};
};

PhotoReferences references_of(const PosedPhotos& posed, const Photos& photos, const PhotoControl& control,
                              const std::string& crs, std::vector<std::string>& messages) {
  PhotoReferences out{.crs = control.crs};
  const auto is_posed = [&](std::size_t image) {
    return posed.scene.images[image].world_from_camera.has_value();
  };
  for (pipeline::ControlPoint point : control.points) {
    std::erase_if(point.marks, [&](const pipeline::Mark& m) { return !is_posed(m.image); });
    out.seen.control.push_back(std::move(point));
  }
  const std::string contradiction = control.points.empty() ? "" : contradiction_of_positions(control, photos);
  if (!contradiction.empty()) {
    messages.push_back(contradiction);
    return out;
  }
  const PhotoPriors priors = photo_priors(photos, control.crs.empty() ? crs : control.crs);
  messages.insert(messages.end(), priors.warnings.begin(), priors.warnings.end());
  if (out.crs.empty()) out.crs = priors.crs;
  out.seen.height_bias_sd = PriorAccuracy{}.height_bias;
  for (const pipeline::ObservedPosition& p : priors.positions)
    if (is_posed(p.image)) out.seen.positions.push_back(p);
  for (const pipeline::ObservedAttitude& a : priors.attitudes)
    if (is_posed(a.image)) out.seen.attitudes.push_back(a);
  for (const pipeline::ObservedUp& up : priors.ups)
    if (is_posed(up.image)) out.seen.ups.push_back(up);
  for (const pipeline::ObservedHeight& h : priors.heights)
    if (is_posed(h.image)) out.seen.heights.push_back(h);
  return out;
}

// Covariances are scaled by the sigma0 of all observations, which is that of the many marks: deviations of an
// altimeter are stated in its unit.
void add_altimeter(const PosedPhotos& posed, const PhotoAltimeter& altimeter, pipeline::Observations& seen) {
  const double sigma0 = posed.scene.sigma0 > 0 ? posed.scene.sigma0 : 1;
  const auto is_posed = [&](std::size_t i) { return posed.scene.images[i].world_from_camera.has_value(); };
  for (pipeline::ObservedHeightAboveGround h : altimeter.above_ground) {
    h.sd /= sigma0;
    if (is_posed(h.image)) seen.heights_above_ground.push_back(h);
  }
  for (pipeline::ObservedHeight h : altimeter.heights) {
    h.sd /= sigma0;
    if (is_posed(h.image)) seen.heights.push_back(h);
  }
}

std::size_t cameras_looking_up(const pipeline::Reconstruction& scene) {
  std::size_t count = 0;
  for (const pipeline::AdjustedImage& image : scene.images)
    count += image.world_from_camera && image.world_from_camera->linear()(2, 2) > 0.5;
  return count;
}

// A plane and its mirror image differ only by the side from which they are seen.
std::string mirrored(const PhotoReferences& references, std::size_t looking_up, std::size_t posed) {
  const bool by_control = references.seen.control.size() >= 3;
  return fmt::format(
      "the frame is arbitrary: {} fit the images only if {} of {} cameras look up, as a mirror image would; "
      "{}",
      by_control ? "the control points" : "the GPS positions", looking_up, posed,
      by_control ? "check that easting comes before northing and that the marks are columns and rows"
                 : "check that latitude and longitude are not exchanged and that the hemispheres are right");
}

double rms_in_plan(const pipeline::AdjustmentResult& adjustment) {
  double squares = 0, used = 0;
  for (const pipeline::ObservationResult& seen : adjustment.others)
    if (seen.kind == "position" && seen.used) squares += seen.error.head<2>().squaredNorm(), ++used;
  return used > 0 ? std::sqrt(squares / used) : 0;
}

// Tie points within one cell of the DEM share its error, and neighbouring cells do as far as the residuals
// correlate: each then counts for its part only.
double deviation_of_surface(const std::vector<Eigen::Vector3d>& points, const Similarity& map_from_frame,
                            const pipeline::CoarseHeights& dem, double residual) {
  Grid<float> above(dem.grid.columns, dem.grid.rows, std::numeric_limits<float>::quiet_NaN());
  double cells = 0;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d at = map_from_frame * point;
    const std::int64_t column = std::llround(dem.grid.column(at.x())),
                       row = std::llround(dem.grid.row(at.y()));
    if (!above.contains(column, row)) continue;
    cells += std::isnan(above(column, row));
    above(column, row) = static_cast<float>(at.z() - dem.at(at.x(), at.y()));
  }
  const double shared = pipeline::correlation_of(above, 3 * std::max(dem.sd, residual)).shared_cells(above);
  return std::max(dem.sd, residual) * std::sqrt(double(points.size()) / std::max(1.0, cells) * shared);
}

// Places images without another reference in the coarse DEM, and adjusts them with it.
void georeference_on_dem(PosedPhotos& posed, pipeline::Observations seen, const PosePhotosRequest& request) {
  constexpr std::int64_t kNodes = 1024;  // across
  std::optional<Crs> map;
  if (!request.crs.empty()) map = request.crs == "local" ? Crs::local() : Crs::from_text(request.crs);
  const CoarseDem dem(request.dem, map);
  const pipeline::CoarseHeights heights = dem.sample_all(kNodes);
  const FreeRelief relief = free_relief(posed.scene, seen);
  const pipeline::DemPlacementResult placed = pipeline::place_on_dem(relief.view(), heights);
  if (!placed.found) {
    posed.messages.push_back("the frame is arbitrary: " + placed.message +
                             "; control points or GPS positions give it for certain");
    return;
  }
  pipeline::Reconstruction moved = posed.scene;
  pipeline::transform(moved, relief.component, placed.found->map_from_frame);
  moved.frame = pipeline::ReconstructionFrame::metric;
  const double deviation =
      deviation_of_surface(relief.points, placed.found->map_from_frame, heights, placed.found->residual);
  seen.surface =
      pipeline::ObservedSurface{.height =
                                    [&heights](double x, double y) {
                                      const double h = heights.at(x, y);
                                      return std::isfinite(h) ? std::optional(h) : std::nullopt;
                                    },
                                // Covariances are scaled by the sigma0 of all observations, which is that of
                                // the many marks: those of the surface are stated in its unit.
                                .sd = deviation / (moved.sigma0 > 0 ? moved.sigma0 : 1),
                                .step = heights.grid.cell / 2};
  const pipeline::Georeferenced result =
      pipeline::georeference(moved, seen, {.free_lens_parameters = admitted_parameters(posed)});
  if (!result.metric) {
    for (const std::string& message : result.messages) posed.messages.push_back(message);
    return;
  }
  posed.scene = std::move(moved);
  posed.crs = text_of_crs(dem.map());
  const double scale_sd = std::sqrt(placed.found->covariance(6, 6));
  posed.messages.push_back(fmt::format(
      "placed in the coarse DEM by its relief of {:.3g} m: residuals {:.3g} m, {}; scale +- {:.2g} %",
      placed.found->relief, placed.found->residual,
      std::isfinite(placed.found->next_best_residual)
          ? fmt::format("the next best place {:.3g} m", placed.found->next_best_residual)
          : std::string("no other place is similar"),
      100 * scale_sd));
}

// Gives images without another reference a frame of true size by their heights.
void georeference_by_heights(PosedPhotos& posed, const pipeline::Observations& seen) {
  std::size_t component = 0;
  for (const pipeline::AdjustedImage& image : posed.scene.images)
    if (image.world_from_camera) component = image.component;
  const pipeline::FrameByHeightsResult placed = pipeline::frame_by_heights(posed.scene, seen, component);
  if (!placed.found) {
    posed.messages.push_back("the frame is arbitrary: " + placed.message +
                             "; control points, GPS positions or other heights give it");
    return;
  }
  pipeline::Reconstruction moved = posed.scene;
  pipeline::transform(moved, component, placed.found->local_from_frame);
  moved.frame = pipeline::ReconstructionFrame::metric;
  const pipeline::AdjustmentResult adjusted =
      pipeline::adjust(moved, seen, {.free_lens_parameters = admitted_parameters(posed)});
  constexpr int kWithoutScale = 6;
  if (adjusted.free_datum > kWithoutScale) {
    posed.messages.push_back(
        "the frame is arbitrary: no height could be compared with the ground below the camera");
    return;
  }
  posed.scene = std::move(moved);
  posed.crs = "local";
  posed.messages.push_back(
      fmt::format("a local frame of true size by {} heights, scale +- {:.2g} %: its position and direction "
                  "are conventional, {}",
                  placed.found->readings, 100 * placed.found->scale_sd,
                  seen.ups.empty() ? "and it is level with the mean plane of the terrain"
                                   : "and it is level by the gimbals"));
  for (const pipeline::ObservationResult& one : adjusted.others)
    if (!one.used && one.kind.starts_with("height") && posed.scene.images[one.image].world_from_camera)
      posed.messages.push_back(
          fmt::format("the {} of image {} contradicts the others, or the ground below it is not "
                      "known; it was left out",
                      one.kind, posed.scene.images[one.image].name));
}

}  // namespace

void georeference_photos(PosedPhotos& posed, const Photos& photos, const SurveyedReferences& surveyed,
                         const pipeline::CalibratedAdjustment& calibrated, const PosePhotosRequest& request,
                         const Callbacks& callbacks) {
  const PhotoControl& control = surveyed.control;
  for (const std::string& warning : control.warnings) callbacks.warning(warning);
  for (const std::string& warning : surveyed.altimeter.warnings) callbacks.warning(warning);
  PhotoReferences references = references_of(posed, photos, control, request.crs, posed.messages);
  references.seen.lenses = calibrated.priors;
  add_altimeter(posed, surveyed.altimeter, references.seen);
  pipeline::Reconstruction moved = posed.scene;
  const pipeline::Georeferenced result =
      pipeline::georeference(moved, references.seen, {.free_lens_parameters = admitted_parameters(posed)});
  if (!result.metric) {
    if (!request.map_image.empty() && control.points.empty() && references.seen.positions.size() < 3)
      return place_photos_in_image(posed, photos, references.seen, admitted_parameters(posed), request);
    if (!request.dem.empty() && control.points.empty() && references.seen.positions.size() < 3)
      return georeference_on_dem(posed, references.seen, request);
    const bool heights = !references.seen.heights.empty() || !references.seen.heights_above_ground.empty();
    if (heights && control.points.empty() && references.seen.positions.empty())
      return georeference_by_heights(posed, references.seen);
    for (const std::string& message : result.messages) posed.messages.push_back(message);
    return;
  }
  for (const std::string& message : result.messages) callbacks.warning(message);
  if (!request.map_image.empty())
    callbacks.warning(
        fmt::format("{} is not used: {} give the frame", request.map_image,
                    control.points.empty() ? "the positions of the images" : "the control points"));
  if (const std::size_t up = cameras_looking_up(moved); 2 * up > posed.posed) {
    posed.messages.push_back(mirrored(references, up, posed.posed));
    return;
  }
  posed.scene = std::move(moved);
  posed.crs = references.crs;
  posed.control = result.adjustment.control;
  posed.gps_rms = rms_in_plan(result.adjustment);
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/report_reconstruction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "workflows/reconstruction/pose_summary.hpp"

namespace waymark::workflows {
namespace {

// Where the corners of an image meet a level plane; empty if one of them does not.
std::vector<Eigen::Vector2d> footprint_of(const Camera& camera, const Eigen::Isometry3d& world_from_camera,
                                          double height) {
  std::vector<Eigen::Vector2d> out;
  const double right = double(camera.columns) - 0.5, bottom = double(camera.rows) - 0.5;
  const Eigen::Vector2d corners[] = {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
  const Eigen::Vector3d centre = world_from_camera.translation();
  for (const Eigen::Vector2d& corner : corners) {
    const auto direction = ray(camera, corner);
    if (!direction) return {};
    const Eigen::Vector3d in_world = world_from_camera.linear() * direction->unit;
    const double along = (height - centre.z()) / in_world.z();
    if (!(along > 0) || !(along * in_world.head<2>().norm() < 20 * std::abs(height - centre.z()))) return {};
    out.emplace_back((centre + along * in_world).head<2>());
  }
  return out;
}

double median_height(const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : points) heights.push_back(p.z());
  if (heights.empty()) return 0;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

exporters::ReportedPoint reported_point(const pipeline::ControlResult& result) {
  exporters::ReportedPoint out{.name = result.name,
                               .check = result.check,
                               .used = result.used,
                               .mark_rms = result.mark_rms,
                               .statistic = result.statistic};
  if (!result.position) return out;
  out.at = *result.position - result.error;
  out.error = result.error;
  if (result.covariance) out.sd = result.covariance->diagonal().cwiseSqrt();
  return out;
}

void add_frame(exporters::ReconstructionReport& report, const std::string& crs) {
  report.metric = !crs.empty();
  report.frame = "Arbitrary position, direction and scale";
  if (!report.metric) return;
  report.crs = crs == "local" ? Crs::local() : Crs::from_text(crs);
  report.frame = crs == "local" ? "Local metres" : report.crs->name() + " (" + report.crs->id() + ")";
}

// Every n-th cell of a grid.
template <class T>
Grid<T> thinned(const Grid<T>& cells, std::int64_t step) {
  Grid<T> out((cells.columns() + step - 1) / step, (cells.rows() + step - 1) / step);
  for (std::int64_t r = 0; r < out.rows(); ++r)
    for (std::int64_t c = 0; c < out.columns(); ++c) out(c, r) = cells(c * step, r * step);
  return out;
}

}  // namespace

exporters::ReconstructionReport report_of_poses(const PosedPhotos& posed) {
  exporters::ReconstructionReport report{.title = "Reconstruction", .messages = posed.messages};
  add_frame(report, posed.crs);
  for (const pipeline::TiePoint& point : posed.scene.points)
    if (point.position) report.points.push_back(*point.position);
  const double height = median_height(report.points);
  const std::vector<PoseFigures> figures = pose_figures(posed.scene);
  double squares = 0, marks = 0;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const pipeline::AdjustedImage& image = posed.scene.images[i];
    exporters::ReportedImage& out = report.images.emplace_back();
    out = {.name = image.name,
           .points = figures[i].points,
           .rms = figures[i].rms,
           .position_sd = figures[i].position_sd,
           .attitude_sd = figures[i].attitude_sd};
    squares += double(figures[i].points) * figures[i].rms * figures[i].rms;
    marks += double(figures[i].points);
    if (!image.world_from_camera) continue;
    out.centre = image.world_from_camera->translation();
    out.footprint = footprint_of(posed.scene.lenses[image.lens].camera, *image.world_from_camera, height);
  }
  for (const pipeline::ControlResult& point : posed.control) report.control.push_back(reported_point(point));
  for (const pipeline::LadderStep& step : posed.ladder)
    report.lenses.push_back({step.lens, step.parameter, step.admitted, step.value, step.sd, step.reason});
  for (const UnusedPhoto& failure : posed.failures)
    report.failures.emplace_back(failure.name, failure.reason);
  report.facts = {
      {fmt::format("{} of {}", posed.posed, posed.posed + posed.failures.size()), "images with a pose"},
      {fmt::format("{}", report.points.size()), "tie points"},
      {fmt::format("{:.2f} px", marks > 0 ? std::sqrt(squares / marks) : 0), "residuals of tie points"}};
  for (const bool check : {false, true}) {
    const ControlFigures control = control_figures(posed.control, check);
    if (control.used > 0)
      report.facts.emplace_back(
          fmt::format("{} / {}", metres(control.plan()), metres(control.rms.z())),
          fmt::format("{} {} points, RMS in plan / height", control.used, check ? "check" : "control"));
  }
  return report;
}

exporters::ReconstructionReport report_of_cameras(const PosedImages& posed, double height) {
  exporters::ReconstructionReport report{.title = "Reconstruction"};
  add_frame(report, text_of_crs(posed.crs));
  report.points = posed.points;
  for (const ImageHandle& handle : posed.images) {
    const PosedCamera& view = *handle->info().view;
    const Eigen::Matrix3d attitude = view.covariance.topLeftCorner<3, 3>(),
                          position = view.covariance.bottomRightCorner<3, 3>();
    report.images.push_back(
        {.name = handle->info().name,
         .centre = view.centre().xyz,
         .footprint = footprint_of(view.camera, view.grid_from_camera.transform, height),
         .position_sd = std::sqrt(position.diagonal().maxCoeff()),
         .attitude_sd = std::sqrt(attitude.diagonal().maxCoeff()) * 180 / std::numbers::pi});
  }
  report.facts = {{fmt::format("{}", report.images.size()), "images with given poses"}};
  return report;
}

exporters::ReportedSurface reported_surface(const pipeline::SurfaceHeights& dem,
                                            const pipeline::Orthophoto& ortho, std::int64_t pixels) {
  const std::int64_t step = std::max<std::int64_t>(1, std::max(dem.grid.columns, dem.grid.rows) / pixels);
  exporters::ReportedSurface out{.west = dem.grid.west,
                                 .north = dem.grid.north,
                                 .cell = dem.grid.cell * double(step),
                                 .heights = thinned(dem.height, step),
                                 .sd = thinned(dem.sd, step),
                                 .reasons = thinned(dem.reason, step),
                                 .full_cell = dem.grid.cell};
  for (int i = 0; i < pipeline::kNoHeightReasons; ++i)
    out.counts.emplace_back(pipeline::reason_text(static_cast<pipeline::NoHeight>(i)),
                            dem.counts[static_cast<std::size_t>(i)]);
  if (ortho.grid.columns > 0)
    out.brightness = thinned(
        ortho.brightness, std::max<std::int64_t>(1, std::max(ortho.grid.columns, ortho.grid.rows) / pixels));
  return out;
}

}  // namespace waymark::workflows

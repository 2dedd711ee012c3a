// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

namespace waymark::workflows {
namespace {

double largest_axis(const Eigen::Matrix3d& covariance) {
  return std::sqrt(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
}

std::string lens_line(const pipeline::AdjustedLens& lens, std::size_t index, std::size_t images) {
  const Camera& c = lens.camera;
  std::string text =
      fmt::format("  lens {}: {} images of {} x {}, f {:.2f} px", index + 1, images, c.columns, c.rows, c.fx);
  for (std::size_t k = 0; k < lens.parameters.size(); ++k) {
    const double sd = std::sqrt(lens.covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
    text += fmt::format("{} {} +- {:.2g}", k == 0 ? "; adjusted:" : ",", lens.parameters[k], sd);
  }
  return text + (lens.parameters.empty() ? "; kept fixed\n" : "\n");
}

// Largest motions while the rows of one lens were read out; empty for a global shutter.
std::string shutter_line(const pipeline::Reconstruction& scene, std::size_t lens) {
  const double readout = scene.lenses[lens].readout_time;
  if (!(readout > 0)) return {};
  std::size_t images = 0, moving = 0;
  double pixels = 0;
  for (const pipeline::AdjustedImage& image : scene.images) {
    if (image.lens != lens || !image.world_from_camera) continue;
    ++images;
    if (!image.motion) continue;
    ++moving;
    pixels = std::max(pixels, image.motion->turn.norm() * scene.lenses[lens].camera.fx);
  }
  return fmt::format("    rolling shutter of {:.3g} ms: the motion of {} of {} images is estimated; {}\n",
                     1e3 * readout, moving, images,
                     moving > 0 ? fmt::format("they turn by up to {:.1f} px meanwhile", pixels)
                                : std::string("without times of exposure it is not modelled"));
}

double median_position_sd(const pipeline::Reconstruction& scene) {
  std::vector<double> all;
  for (const PoseFigures& image : pose_figures(scene))
    if (image.position_sd > 0) all.push_back(image.position_sd);
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[all.size() / 2];
}

std::string height_text(const pipeline::ControlResult& point) {
  return std::isnan(point.error.z()) ? "       -" : fmt::format("{:8.3f}", point.error.z());
}

std::string control_text(const PosedPhotos& posed) {
  std::string text;
  for (const bool check : {false, true}) {
    const ControlFigures figures = control_figures(posed.control, check);
    const auto all = std::ranges::count(posed.control, check, &pipeline::ControlResult::check);
    if (all == 0) continue;
    text += fmt::format("  {} of {} {} points", figures.used, all, check ? "check" : "control");
    text += figures.used > 0 ? fmt::format(": RMS {} in plan, {} in height\n", metres(figures.plan()),
                                           metres(figures.rms.z()))
                             : " used\n";
  }
  for (const pipeline::ControlResult& point : posed.control) {
    text += fmt::format("    {:<7} {:<12}", point.check ? "check" : "control", point.name);
    text += point.position ? fmt::format(" {:8.3f} {:8.3f} {} m, marks {:.2f} px", point.error.x(),
                                         point.error.y(), height_text(point), point.mark_rms)
                           : " no position";
    text += point.check || point.used ? "\n" : ", not used\n";
  }
  return text;
}

}  // namespace

std::optional<Eigen::Vector2d> residual_of(const pipeline::Reconstruction& scene,
                                           const pipeline::TiePoint& tie, const pipeline::Mark& mark) {
  const pipeline::AdjustedImage& image = scene.images[mark.image];
  if (!tie.position || !image.world_from_camera) return std::nullopt;
  const auto seen =
      project(scene.lenses[image.lens].camera,
              Point<CameraFrame>{pipeline::pose_of_mark(scene, mark).inverse() * *tie.position});
  if (!seen) return std::nullopt;
  return *seen - mark.pixel;
}

std::string metres(double error) {
  return std::isnan(error) ? "not surveyed" : fmt::format("{:.3f} m", error);
}

std::vector<PoseFigures> pose_figures(const pipeline::Reconstruction& scene) {
  std::vector<PoseFigures> out(scene.images.size());
  for (const pipeline::TiePoint& tie : scene.points)
    for (const pipeline::Mark& m : tie.marks)
      if (const auto residual = residual_of(scene, tie, m)) {
        ++out[m.image].points;
        out[m.image].rms += residual->squaredNorm();
      }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].points > 0) out[i].rms = std::sqrt(out[i].rms / double(2 * out[i].points));
    if (const auto& covariance = scene.images[i].covariance) {
      out[i].attitude_sd = largest_axis(covariance->topLeftCorner<3, 3>()) * 180 / std::numbers::pi;
      out[i].position_sd = largest_axis(covariance->bottomRightCorner<3, 3>());
    }
  }
  return out;
}

ControlFigures control_figures(std::span<const pipeline::ControlResult> control, bool check) {
  ControlFigures out;
  Eigen::Vector3d surveyed = Eigen::Vector3d::Zero();
  for (const pipeline::ControlResult& point : control) {
    if (point.check != check || !point.position || !(point.check || point.used)) continue;
    ++out.used;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isnan(point.error[axis])) continue;
      out.rms[axis] += point.error[axis] * point.error[axis];
      ++surveyed[axis];
    }
  }
  out.rms = (out.rms.array() / surveyed.array()).sqrt();  // NaN where nothing was surveyed
  return out;
}

std::string pose_summary(const PosedPhotos& posed, const std::vector<exporters::SparsePoint>& points) {
  double squares = 0, marks = 0;
  for (const exporters::SparsePoint& point : points) {
    squares += 2 * double(point.marks.size()) * point.error * point.error;
    marks += double(point.marks.size());
  }
  std::string text = fmt::format("{} of {} images posed", posed.posed, posed.posed + posed.failures.size());
  if (posed.components.size() > 1)
    text += fmt::format("; the images form {} groups without common points: {}", posed.components.size(),
                        fmt::join(posed.components, ", "));
  text += fmt::format("\n  {} of {} pairs matched; {} tie points, {:.1f} marks each\n", posed.pairs_matched,
                      posed.pairs_tried, points.size(), points.empty() ? 0 : marks / double(points.size()));
  text += fmt::format("  residuals {:.2f} px RMS, sigma0 {:.2f}\n",
                      marks > 0 ? std::sqrt(squares / (2 * marks)) : 0, posed.scene.sigma0);
  for (std::size_t lens = 0; lens < posed.scene.lenses.size(); ++lens) {
    const auto images = static_cast<std::size_t>(std::ranges::count_if(
        posed.scene.images,
        [&](const pipeline::AdjustedImage& i) { return i.lens == lens && i.world_from_camera; }));
    text += lens_line(posed.scene.lenses[lens], lens, images) + shutter_line(posed.scene, lens);
  }
  if (!posed.crs.empty()) {
    text += fmt::format("  frame: {}; median sd of the centres {:.3f} m", posed.crs,
                        median_position_sd(posed.scene));
    if (posed.gps_rms > 0) text += fmt::format("; residuals of GPS {:.2f} m RMS in plan", posed.gps_rms);
    text += "\n" + control_text(posed);
  }
  for (const std::string& message : posed.messages) text += fmt::format("  {}\n", message);
  if (posed.crs.empty()) text += "  frame: arbitrary position, direction and scale\n";
  for (const UnusedPhoto& failure : posed.failures)
    text += fmt::format("  not posed: {}: {}\n", failure.name, failure.reason);
  return text;
}

}  // namespace waymark::workflows

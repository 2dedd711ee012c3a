// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "exporters/cameras/camera_file.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// Figures of one image with a pose.
struct PoseFigures {
  std::size_t points = 0;  ///< tie points with a mark in it
  double rms = 0;          ///< residuals of these marks, pixels
  double position_sd = 0;  ///< largest axis of the error ellipsoid of the centre, metres; 0: unknown
  double attitude_sd = 0;  ///< largest, about any axis, degrees; 0: unknown
};

/// Returns the projection of a tie point less its mark, pixels; `std::nullopt` if the image or the point has
/// no position, or the image cannot show it.
std::optional<Eigen::Vector2d> residual_of(const pipeline::Reconstruction& scene,
                                           const pipeline::TiePoint& tie, const pipeline::Mark& mark);

/// Returns the figures of all images; those without a pose have zeros.
std::vector<PoseFigures> pose_figures(const pipeline::Reconstruction& scene);

/// Root mean square errors of surveyed points, metres.
struct ControlFigures {
  std::size_t used = 0;
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();  ///< easting, northing, height; of those surveyed

  double plan() const { return rms.head<2>().norm(); }
};

/// Returns the figures of the control points that are used, or of the check points that have a position.
ControlFigures control_figures(std::span<const pipeline::ControlResult> control, bool check);

/// Returns a root mean square error as text; "not surveyed" for NaN.
std::string metres(double error);

/// Returns the result as text for people: images, residuals, lenses, surveyed points, frame, failures.
std::string pose_summary(const PosedPhotos& posed, const std::vector<exporters::SparsePoint>& points);

}  // namespace waymark::workflows

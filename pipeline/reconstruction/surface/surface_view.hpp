// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
#include "geo/camera.hpp"
#include "geo/image_source.hpp"
#include "geo/sun.hpp"
namespace waymark::pipeline {

/// Covariance of the lens parameters of some images, as in AdjustedLens.
struct LensCovariance {
  std::vector<std::string> parameters = {};  ///< "f", "cx", "cy", "k1", "k2", "p1", "p2"
  Eigen::MatrixXd covariance = {};           ///< of `parameters`, in their order
};

/// Image with its pose, from which heights are measured.
struct SurfaceView {
  std::string name = {};  ///< unique
  PosedCamera view = {};
  std::optional<Sun> sun = {};
  ImageHandle image = {};
  LensCovariance lens = {};  ///< no parameters: the lens is exact
};

/// Returns the views of the images that have a pose, sorted by name.
std::vector<SurfaceView> surface_views(const ImageSet& images);

/// Returns the ground sample distance at a point: the side of the square of level ground that a pixel covers,
/// metres. Infinity where the view does not see the point, or sees level ground edge-on.
double ground_sample_distance(const PosedCamera& view, const Eigen::Vector3d& point);

/// Returns the angle between the rays from a point to two cameras, radians.
double convergence_angle(const PosedCamera& a, const PosedCamera& b, const Eigen::Vector3d& point);

/// Returns whether a projection lies in the image, at least `margin` pixels from its border.
bool in_image(const Camera& camera, const Eigen::Vector2d& pixel, double margin);

}  // namespace waymark::pipeline

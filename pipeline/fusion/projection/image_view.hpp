// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#include "geo/camera.hpp"
#include "geo/sun.hpp"
namespace waymark::pipeline {

/// Grid of an orthophoto: centre of pixel (0, 0) and steps, metres in the grid frame.
/// step_x > 0; step_y < 0 if rows run south.
struct OrthoGrid {
  double x0 = 0, y0 = 0;
  double step_x = 1, step_y = -1;
  friend bool operator==(const OrthoGrid&, const OrthoGrid&) = default;
};

/// Gaussian constraint on the correction of a pose (rotations about the camera's axes, then the centre, as in
/// PosedCamera::covariance): information matrix and information vector.
struct PoseConstraint {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector<double, 6> information_vector = Eigen::Vector<double, 6>::Zero();
};

/// Distance between the relief that an image shows and that of the DEM (dem_shift.hpp).
struct DemShift {
  Eigen::Vector2d metres = Eigen::Vector2d::Zero();      ///< east, north: image minus DEM
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of `metres`
  Eigen::Matrix2d stated = Eigen::Matrix2d::Zero();      ///< covariance that the stated pose gives the ground
  double cell = 0;                                       ///< size of the cells compared, metres
};

/// View of an image: everything that merging, valuation and the map's layer `image` need after its pixels
/// were read.
/// Either `view` or `ortho` is set.
struct ImageView {
  using Ring = std::vector<Eigen::Vector2d>;  ///< x, y in units of the map's CRS, closed by its first corner

  std::string name;  ///< unique in the map; Observation::source refers to it
  std::int64_t columns = 0, rows = 0;
  std::optional<PosedCamera> view;
  std::optional<OrthoGrid> ortho;
  std::optional<Sun> sun;
  std::string taken_utc;                                  ///< ISO 8601; empty: unknown
  std::vector<Ring> footprint;                            ///< visible ground; one ring per part, no holes
  double area = 0;                                        ///< of the footprint, square metres
  double gsd = std::numeric_limits<double>::quiet_NaN();  ///< typical ground sample distance, metres
  /// Covariance (east, north) of the position error common to all images, square metres. Not contained in the
  /// covariances of aligned observations (alignment.hpp).
  Eigen::Matrix2d common_covariance = Eigen::Matrix2d::Zero();
  std::optional<PoseConstraint> dem_constraint;  ///< from registration to the DEM (dem_registration.hpp)
  std::optional<DemShift> dem_shift;  ///< where shading and brightness determine it (dem_shift.hpp)
};

/// Returns camera model and pose, or the georeference of the orthophoto, as one line of JSON for the map's
/// layer `image`.
std::string camera_json(const ImageView& image);

}  // namespace waymark::pipeline

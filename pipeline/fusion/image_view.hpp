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
namespace waymark {

/// Where the pixels of an orthophoto lie: centre of pixel (0, 0) and steps, metres in the grid frame.
/// step_x > 0; step_y < 0 where rows run south.
struct OrthoGrid {
  double x0 = 0, y0 = 0;
  double step_x = 1, step_y = -1;
  friend bool operator==(const OrthoGrid&, const OrthoGrid&) = default;
};

/// What is known of the correction of a pose (about the camera's axes, then the centre, as in
/// PosedCamera::covariance): how surely, and that times the correction.
struct PoseTie {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector<double, 6> pull = Eigen::Vector<double, 6>::Zero();
};

/// What an image looks at: all that merging, valuation and the map's layer `image` need once its pixels have
/// been read. Either `view` or `ortho` is there.
struct ImageView {
  using Ring = std::vector<Eigen::Vector2d>;  ///< x, y in units of the map's CRS, closed by its first corner

  std::string name;  ///< unique in the map; Observation::source refers to it
  std::int64_t columns = 0, rows = 0;
  std::optional<PosedCamera> view;
  std::optional<OrthoGrid> ortho;
  std::optional<Sun> sun;
  std::string taken_utc;        ///< ISO 8601; empty: unknown
  std::vector<Ring> footprint;  ///< ground it shows, hidden ground left out; one ring per part, no holes
  double area = 0;              ///< of the footprint, square metres
  double gsd = std::numeric_limits<double>::quiet_NaN();  ///< typical ground sample distance, metres
  /// East, north: what all images of the map are off by together, square metres; not in the covariances of
  /// observations that were aligned (see alignment.hpp).
  Eigen::Matrix2d common = Eigen::Matrix2d::Zero();
  std::optional<PoseTie> on_ground;  ///< by comparison with the DEM (ground_match.hpp)
};

/// Model and pose of the camera, or the georeference of the orthophoto, as the map's layer `image` tells it:
/// one line of JSON.
std::string camera_json(const ImageView& image);

}  // namespace waymark

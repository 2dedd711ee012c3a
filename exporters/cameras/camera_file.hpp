// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>
#include "geo/camera.hpp"
#include "geo/sun.hpp"
namespace waymark::exporters {

/// Image of a camera file.
struct CameraFileImage {
  std::string name = {};
  std::size_t lens = 0;                                        ///< index into `CameraFileContent::lenses`
  std::optional<Eigen::Isometry3d> world_from_camera = {};     ///< OpenCV axes
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = {};  ///< as in PosedCamera
  std::optional<ShutterMotion> motion = {};                    ///< as in PosedCamera
  std::optional<Sun> sun = {};
  std::string taken_utc = {};  ///< ISO 8601; empty: unknown
};

/// Lens of a camera file.
struct CameraFileLens {
  Camera camera = {};
  double readout_time = 0;  ///< s from the first row to the last: a rolling shutter; 0: global
};

/// Content of a camera file.
struct CameraFileContent {
  std::optional<std::string> crs = {};  ///< of axes `grid`; `std::nullopt`: `arbitrary`
  std::vector<CameraFileLens> lenses = {};
  std::vector<CameraFileImage> images = {};
};

/// Returns the camera file (docs/reference/camera_file.md). Images without a pose are listed without.
std::string camera_file_text(const CameraFileContent& content);

/// Point of a sparse reconstruction, for COLMAP and PLY.
struct SparsePoint {
  struct SeenIn {
    std::size_t image = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  };
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double sd = 0;     ///< largest of the axes of its error ellipsoid, metres; 0: unknown
  double error = 0;  ///< root mean square residual, pixels
  std::vector<SeenIn> marks = {};
};

/// Text model of COLMAP: cameras.txt, images.txt, points3D.txt. Pixel centres are at 0.5 there.
struct ColmapModel {
  std::string cameras, images, points;
};
ColmapModel colmap_model(const CameraFileContent& content, const std::vector<SparsePoint>& points);

/// Returns the points as PLY (ASCII): x y z, sd, number of images.
std::string ply_text(const std::vector<SparsePoint>& points);

}  // namespace waymark::exporters

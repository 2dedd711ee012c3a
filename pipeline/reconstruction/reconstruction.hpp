// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>
#include "geo/camera.hpp"
namespace waymark::pipeline {

/// Image point of a track: where an image shows a tie point or a control point.
struct Mark {
  std::size_t image = 0;  ///< index into `Reconstruction::images`
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sd = 1;  ///< of each coordinate, pixels
};

/// Tie point: its marks and, once triangulated, its position.
struct TiePoint {
  std::vector<Mark> marks = {};                    ///< at most one per image, in the order of the images
  std::optional<Eigen::Vector3d> position = {};    ///< in the frame of the reconstruction
  std::optional<Eigen::Matrix3d> covariance = {};  ///< of the position
};

/// Camera as adjusted; images of one camera share it.
struct AdjustedLens {
  Camera camera = {};
  std::vector<std::string> parameters = {};  ///< adjusted ones: "f", "cx", "cy", "k1", "k2", "p1", "p2"
  Eigen::MatrixXd covariance = {};           ///< of `parameters`, in their order
  double readout_time = 0;  ///< s from the first row to the last: a rolling shutter; 0: global
};

/// Image with its pose, if it has one.
struct AdjustedImage {
  std::string name = {};
  std::size_t lens = 0;  ///< index into `Reconstruction::lenses`
  /// Of the middle row. OpenCV axes: x right, y down, z forward.
  std::optional<Eigen::Isometry3d> world_from_camera = {};
  /// Of the rotation (radians, about the axes of the camera), then of the centre, as in PosedCamera.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = {};
  std::size_t component = 0;        ///< images of different components share no tie points
  std::optional<double> time = {};  ///< s, since any instant common to all images
  /// While the rows were read out; none: the shutter is global, or the motion is unknown.
  std::optional<ShutterMotion> motion = {};
};

/// What the frame of a reconstruction is worth.
enum class ReconstructionFrame {
  arbitrary,  ///< position, direction and scale unknown
  metric,     ///< axes and metres of the map's CRS
};

/// Images, lenses and tie points in one frame: the result of an adjustment and the start of the next.
struct Reconstruction {
  ReconstructionFrame frame = ReconstructionFrame::arbitrary;
  std::vector<AdjustedLens> lenses = {};
  std::vector<AdjustedImage> images = {};
  std::vector<TiePoint> points = {};
  double sigma0 = 0;  ///< standard deviation of unit weight of the last adjustment; 0: not adjusted
};

}  // namespace waymark::pipeline

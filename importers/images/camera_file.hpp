// SPDX-License-Identifier: Apache-2.0
// What a reader of camera files is made of: importers/cameras/<format>.cpp defines
// register_camera_format_<format>(CameraFormats&).
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "geo/camera.hpp"
#include "geo/sun.hpp"
namespace waymark {

/// The axes a camera file gives poses in.
struct CameraWorld {
  enum class Axes {
    grid,       ///< easting, northing, height in `crs`, metres; axes of the grid
    enu,        ///< east, north, up about `origin`, metres
    earth,      ///< fixed to the body, from its centre, z to the north pole, metres
    arbitrary,  ///< no known place, direction or scale
  };
  Axes axes = Axes::arbitrary;
  std::string crs = {};  ///< of `grid`; empty: not said
  Eigen::Vector3d origin =
      Eigen::Vector3d::Zero();  ///< of `enu`: longitude, latitude, height; degrees, metres
};

/// "EPSG:32651": the UTM zone of a place on Earth, without the exceptions of Norway and Svalbard.
std::string utm_zone(double lon, double lat);

/// An image as its camera file tells it.
struct CameraRecord {
  std::string image = {};
  std::string place = {};             ///< in the file, for messages: "/images/3", "line 12"
  std::optional<Camera> camera = {};  ///< columns and rows 0: not said; cx, cy NaN: the middle
  std::optional<Eigen::Isometry3d> world_from_camera = {};     ///< OpenCV axes: x right, y down, z forward
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = {};  ///< as PosedCamera's, in the world's axes
  std::optional<Sun> sun = {};
  std::optional<Eigen::Vector3d> towards_sun = {};  ///< in the world's axes, any length
  std::optional<Degrees> image_sun_angle = {};
  std::string taken_utc = {};
};

struct CameraFile {
  CameraWorld world;
  std::vector<CameraRecord> images;
  std::vector<std::string> warnings;
};

/// A file and what helps to read it.
struct CameraSource {
  std::string path;
  std::string head;      ///< first bytes, for recognition
  std::string interior;  ///< path of the interior orientation where the format keeps it apart; may be empty
};

struct CameraFormat {
  std::string name;
  std::string summary;
  std::function<bool(const CameraSource&)> recognises;
  std::function<CameraFile(const CameraSource&)> read;
};

class CameraFormats {
 public:
  void add(CameraFormat format) { all_.push_back(std::move(format)); }
  const std::vector<CameraFormat>& all() const { return all_; }

 private:
  std::vector<CameraFormat> all_;
};

}  // namespace waymark

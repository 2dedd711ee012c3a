// SPDX-License-Identifier: Apache-2.0
// Parts of a camera file reader: importers/cameras/formats/<format>.cpp defines
// register_camera_format_<format>(CameraFormats&).
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
/// Parts of a camera file reader: importers/cameras/formats/<format>.cpp defines
/// register_camera_format_<format>(CameraFormats&).
#include "geo/camera.hpp"
#include "geo/sun.hpp"
namespace waymark::importers {

/// Frame of the poses in a camera file.
struct CameraWorld {
  enum class Axes {
    grid,       ///< easting, northing, height in `crs`, metres; axes of the grid
    enu,        ///< east, north, up about `origin`, metres
    earth,      ///< body-fixed, from the centre of the body, metres; z to the north pole
    arbitrary,  ///< position, direction and scale unknown
  };
  Axes axes = Axes::arbitrary;
  std::string crs = {};  ///< of `grid`; empty: unknown
  Eigen::Vector3d origin =
      Eigen::Vector3d::Zero();  ///< of `enu`: longitude, latitude, height; degrees, metres
};

/// Returns the UTM zone of a position on Earth as "EPSG:32651", without the exceptions of Norway and
/// Svalbard.
std::string utm_zone(double lon, double lat);

/// An image as its camera file describes it.
struct CameraRecord {
  std::string image = {};
  std::string location = {};          ///< in the file, for messages: "/images/3", "line 12"
  std::optional<Camera> camera = {};  ///< columns and rows 0: unknown; cx, cy NaN: the middle
  std::optional<Eigen::Isometry3d> world_from_camera = {};     ///< OpenCV axes: x right, y down, z forward
  std::optional<Eigen::Matrix<double, 6, 6>> covariance = {};  ///< as in PosedCamera, in the world's axes
  std::optional<ShutterMotion> motion = {};                    ///< its shift in the world's axes
  std::optional<Sun> sun = {};
  std::optional<Eigen::Vector3d> towards_sun = {};  ///< in the world's axes, any length
  std::optional<Degrees> image_sun_angle = {};
  std::string taken_utc = {};  ///< ISO 8601, to the millisecond if the file has them
  double readout_time = 0;     ///< s from the first row to the last: a rolling shutter; 0: global
};

/// A lens that a camera file lists apart from its images.
struct LensRecord {
  Camera camera = {};
  double readout_time = 0;  ///< s from the first row to the last: a rolling shutter; 0: global
};

struct CameraFile {
  CameraWorld world;
  std::vector<CameraRecord> images;
  std::vector<std::string> warnings;
  std::vector<LensRecord> lenses = {};  ///< those of no image as well
};

/// A camera file and the input needed to read it.
struct CameraSource {
  std::string path;
  std::string head;  ///< first bytes, for recognition
  std::string
      interior;  ///< path of the interior orientation if the format stores it separately; may be empty
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

}  // namespace waymark::importers

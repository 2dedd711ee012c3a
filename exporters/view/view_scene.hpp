// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "exporters/formatting.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Terrain of a viewer: a grid of heights in the view frame and a picture of the same rectangle.
struct ViewTerrain {
  double west = 0, south = 0;  ///< of the first column and of the last row, metres
  double step = 1;             ///< between nodes, metres
  Grid<float> heights = {};    ///< row 0 in the north; NaN where unknown; empty: no terrain
  std::string picture = {};    ///< JPEG of the rectangle, row 0 in the north; empty: none
  std::string caption = {};    ///< what the picture shows
};

/// A feature of a type as the viewer prints it.
struct ViewFeature {
  std::string title = {}, summary = {};
  NumberFormat format = {};
};

/// One observation that supports a landmark.
struct ViewEvidence {
  std::int32_t source = 0;  ///< index into ViewScene::sources
  float confidence = 0;
};

/// Direction and sizes of a landmark that is no solid of revolution; NaN: unknown.
struct ViewForm {
  float turn = 0;               ///< radians from east to north: normal of a face, or long side
  float length = 0, width = 0;  ///< metres
  float opening = 0, side = 0;  ///< of a corner, radians; of a wall's end, 1 left or -1 right of the face
};

/// A landmark as the viewer draws and describes it.
struct ViewLandmark {
  std::string uid = {}, position = {}, label = {};
  Eigen::Vector3f at = Eigen::Vector3f::Zero();
  float radius = 0, height = 0;        ///< metres; 0: unknown
  float confidence = 0, quality = 0;   ///< quality NaN: not assessed
  std::array<float, 3> sd{};           ///< east, north, up, metres
  std::int32_t seen = 0, visible = 0;  ///< images
  std::vector<std::array<float, 2>> features =
      {};                                   ///< value (NaN: unknown) and standard deviation (0: unknown)
  std::vector<ViewEvidence> evidence = {};  ///< the first few
  std::int32_t observations = 0;            ///< of all its observations
  ViewForm form = {};                       ///< of oriented shapes
};

/// Landmarks of one type.
struct ViewLayer {
  std::string name = {}, title = {}, colour = {};
  std::string shape =
      {};  ///< point, sphere, cylinder, cone, canopy, bowl, or an oriented one (view_form.hpp)
  std::int64_t total = 0;  ///< in the map
  std::vector<ViewFeature> features = {};
  std::vector<ViewLandmark> landmarks = {};  ///< the foremost first
};

/// A pose of a track in the view frame; yaw from east to north.
struct ViewPose {
  double t = 0;
  float x = 0, y = 0, yaw = 0;
  float var_x = 0, var_y = 0, cov_xy = 0;  ///< square metres
  bool lost = false;
};

struct ViewTrack {
  std::string name = {};
  bool is_truth = false;
  std::vector<ViewPose> poses = {};  ///< ascending
};

/// A ray of a sensor, from the robot's position: a laser beam or a sighting.
struct ViewRay {
  float bearing = 0;  ///< radians from the robot's x axis to the left
  float range = 0;    ///< metres, > 0
};

/// What a sensor measured at one time.
struct ViewScan {
  double t = 0;
  bool is_laser = false;        ///< else sightings of landmarks
  Eigen::Vector2f mount{0, 0};  ///< of the sensor on the robot, metres
  std::vector<ViewRay> rays = {};
};

/// A posed image.
struct ViewImage {
  std::string name = {}, jpeg = {};  ///< `jpeg` may be empty: its file is missing
  std::int64_t columns = 0, rows = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();
  std::array<double, 5> lens{};        ///< fx, fy, cx, cy, skew
  std::array<double, 8> distortion{};  ///< as in Camera
  bool is_fisheye = false;
  double max_radius = 0;                     ///< of undistorted image coordinates inside the image
  std::vector<Eigen::Vector3d> border = {};  ///< unit rays along the image's edge, view frame
};

/// Everything that a viewer page shows. The view frame is east, north, up in metres about a point near the
/// middle, so that single precision suffices.
struct ViewScene {
  std::string title = {}, place = {};
  std::vector<std::string> notes = {};  ///< what is left out
  double radius = 1;                    ///< metres, half the diagonal of what is shown
  ViewTerrain terrain = {};
  std::vector<ViewLayer> layers = {};
  std::vector<std::string> sources = {};  ///< of observations
  std::vector<ViewTrack> tracks = {};
  std::vector<ViewScan> scans = {};  ///< ascending
  std::vector<ViewImage> images = {};
};

}  // namespace waymark::exporters

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark::exporters {

/// A landmark as a dot: metres, in the frame of the tracks.
struct PictureDot {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0.3;  ///< metres
  std::string colour = "#888888";
};

struct PictureTrack {
  std::string name;
  localization::Track track;
};

struct TrackPicture {
  std::string title;
  std::vector<PictureDot> map;
  std::vector<localization::StampedPose> truth;
  std::vector<PictureTrack> tracks;  ///< drawn in this order, the first one below
  std::vector<PictureDot> mapped;    ///< drawn as rings
};

/// Returns an SVG page without external references: the map, the true path, and each track with 3-sigma
/// ellipses of its position (ten times as large, or dashed in true size if they would cover the map). Below,
/// the position error of each track over time on a logarithmic scale. Long tracks are thinned to about 1500
/// points.
std::string track_picture(const TrackPicture& picture);

}  // namespace waymark::exporters

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

/// A landmark as a dot: metres, in the frame of the tracks.
struct PictureDot {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double radius = 0.3;  ///< metres
  std::string colour = "#888888";
};

struct PictureTrack {
  std::string name;
  Track track;
};

struct TrackPicture {
  std::string title;
  std::vector<PictureDot> map;
  std::vector<StampedPose> truth;
  std::vector<PictureTrack> tracks;   ///< drawn in this order, the first one below
  std::vector<PictureDot> harvested;  ///< rings
};

/// An SVG page that needs nothing else: the map, the true way, each track with 3-sigma ellipses of its
/// position (ten times as large, or dashed in true size where that would cover the map), and below it the
/// position error of each track over time on a logarithmic scale. Long tracks are thinned to about 1500
/// points.
std::string track_picture(const TrackPicture& picture);

}  // namespace waymark

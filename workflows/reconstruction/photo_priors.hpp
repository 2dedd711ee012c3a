// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

/// What pictures say about their poses, in the grid frame of a CRS.
struct PhotoPriors {
  std::string crs = {};  ///< "AUTHORITY:CODE" or as given; empty: no picture has a position
  std::vector<pipeline::ObservedPosition> positions = {};  ///< `image`: index into `Photos::photos`
  std::vector<pipeline::ObservedAttitude> attitudes = {};
  std::vector<pipeline::ObservedUp> ups = {};          ///< of pictures with a gimbal, but without a position
  std::vector<pipeline::ObservedHeight> heights = {};  ///< of these, above take-off
  std::vector<std::string> warnings = {};              ///< positions that are left out, by image
};

/// Standard deviations of what cameras write.
struct PriorAccuracy {
  double horizontal = 3;              ///< metres, navigation receivers
  double altitude = 10;               ///< metres, besides the bias of all
  double height_above_takeoff = 0.5;  ///< metres, besides the bias of all
  double height_bias = 20;            ///< metres, of all heights
  double tilt = 2, yaw = 4;           ///< degrees, gimbals
};

/// Converts positions and gimbal angles to observations.
/// - Heights are those above take-off plus the median altitude of the take-off, else the altitudes. Both have
///   one bias for all images.
/// - A position more than a degree from the median of all is left out.
/// - `crs` empty: the UTM zone of the first position that is used. Yaw is turned by the meridian convergence.
/// - Pictures without a position give the vertical by their gimbals and heights above take-off.
/// - EXIF orientations that turn the picture turn the attitude, too; mirrored pictures give none.
/// Throws Error{usage} for a CRS in degrees or on another body than Earth.
PhotoPriors photo_priors(const Photos& photos, const std::string& crs, const PriorAccuracy& accuracy = {});

}  // namespace waymark::workflows

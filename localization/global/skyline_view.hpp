// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/global/skyline.hpp"
namespace waymark::localization {

/// Direction and distance of a summit: azimuth from x (east) towards y (north), elevation above the
/// horizontal.
struct SummitView {
  double azimuth = 0, elevation = 0, distance = 1;
};
SummitView view_summit(const SkylineSummit& summit, const Eigen::Vector2d& eye, double eye_height,
                       const SkylineOptions& options);

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/global/skyline.hpp"
namespace waymark {

/// How a summit is seen: azimuth from x (east) towards y (north), elevation over the horizontal.
struct SummitView {
  double azimuth = 0, elevation = 0, distance = 1;
};
SummitView view_of(const SkylineSummit& summit, const Eigen::Vector2d& eye, double eye_height,
                   const SkylineOptions& options);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Landmarks with positions in another CRS: their own, and every attribute pair `<stem>_x`, `<stem>_y` of the
/// type, by convention a position in the map's CRS (a saddle, the end of isolation). An attribute pair
/// outside the domain of `to` becomes NULL. Covariances and directions are turned to the axes of
/// `to` (rotate_axes).
struct Reprojected {
  std::vector<Landmark> landmarks;
  std::int64_t lost = 0;  ///< landmarks that have no position in `to`: left out
};
Reprojected reproject(std::vector<Landmark> landmarks, const LandmarkType& type, const Crs& from,
                      const Crs& to);

}  // namespace waymark::exporters

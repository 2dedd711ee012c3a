// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "localization/identification/landmark_grid.hpp"
namespace waymark::localization {

/// Returns the landmarks inside a box of the map frame, e.g. by a query of a map file.
using LandmarkSource = std::function<std::vector<MapLandmark>(const Eigen::AlignedBox2d&)>;

/// Landmarks around a moving robot: a square of the map in memory, read again when the robot comes near its
/// edge. The cost of an update does not depend on the size of the map.
class LandmarkWindow {
 public:
  /// Holds the whole map in memory.
  explicit LandmarkWindow(LandmarkGrid whole);
  /// Reads `margin` metres, > 0, beyond the requested area; a quarter of the reach if that is more.
  LandmarkWindow(LandmarkSource source, double margin);

  /// Returns at least the landmarks within `reach` of the position. Valid until the next call.
  const LandmarkGrid& landmarks_near(const Eigen::Vector2d& at, double reach);
  bool whole() const { return !source_; }

 private:
  LandmarkSource source_;
  double margin_ = 0;
  Eigen::AlignedBox2d loaded_;
  LandmarkGrid grid_;
};

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include "localization/identification/landmark_grid.hpp"
namespace waymark {

/// Landmarks inside a box of the map frame, e.g. one query of a map file.
using LandmarkSource = std::function<std::vector<MapLandmark>(const Eigen::AlignedBox2d&)>;

/// The landmarks round a robot that moves: a square of the map in memory, read again when the robot comes
/// near its edge. What an update costs then does not depend on the size of the map.
class LandmarkWindow {
 public:
  /// The whole map in memory.
  explicit LandmarkWindow(LandmarkGrid whole);
  /// `margin` metres are read beyond what is asked for, > 0; a quarter of the reach where that is more.
  LandmarkWindow(LandmarkSource source, double margin);

  /// All landmarks within `reach` of the place, and more. Valid until the next call.
  const LandmarkGrid& around(const Eigen::Vector2d& at, double reach);
  bool whole() const { return !source_; }

 private:
  LandmarkSource source_;
  double margin_ = 0;
  Eigen::AlignedBox2d loaded_;
  LandmarkGrid grid_;
};

}  // namespace waymark

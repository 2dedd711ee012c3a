// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Height of the ground around a 3-D scanner: cells of 1 m about the scanner.
class CloudGround {
 public:
  /// Takes per cell the lowest height that a second point confirms within 0.2 m: single points below the
  /// ground are reflections. A cell has the height of the lowest of its 3 x 3 cells, so cells under cars and
  /// in hedges have ground, too; on a slope that is up to 1.5 m x slope too low.
  CloudGround(std::span<const Eigen::Vector3f> points, double max_range);

  /// Returns the height of the ground at a point within `max_range`; NaN where no point is near.
  float at(float x, float y) const;

 private:
  int cells_;  // per side
  float half_;
  std::vector<float> heights_;
};

}  // namespace waymark::localization

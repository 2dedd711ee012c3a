// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Points of a 3-D scan in one cubic cell, as their mean.
struct CloudCell {
  Eigen::Vector3f at;   ///< m, in the frame of the scanner
  float height = 0;     ///< m above the ground
  float intensity = 0;  ///< mean; 0 without intensities
  int points = 0;
};

/// Cells of a 3-D scan above the ground, sorted by column and height. The means are sums of whole numbers
/// (1/4096 m), so they do not depend on the order of the points.
class CloudCells {
 public:
  /// Takes the points within `max_range` m whose height above the ground lies between two bounds, m.
  CloudCells(const PointCloud& cloud, double max_range, double cell, double min_height, double max_height);

  std::span<const CloudCell> cells() const { return cells_; }
  std::size_t size() const { return cells_.size(); }
  const CloudCell& operator[](std::size_t i) const { return cells_[i]; }
  double cell() const { return cell_; }

  /// Calls visit(index) for the cells of the columns within `columns` of that of a cell, and itself, whose
  /// heights differ by at most `rise` m.
  template <class Visit>
  void near(std::size_t of, int columns, double rise, const Visit& visit) const {
    const auto [x, y] = column_of(cells_[of].at);
    for (int v = std::max(0, y - columns); v <= std::min(side_ - 1, y + columns); ++v)
      for (int u = std::max(0, x - columns); u <= std::min(side_ - 1, x + columns); ++u) {
        const std::size_t c =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(u);
        for (std::uint32_t i = starts_[c]; i < starts_[c + 1]; ++i)
          if (std::abs(cells_[i].at.z() - cells_[of].at.z()) <= static_cast<float>(rise)) visit(i);
      }
  }

 private:
  struct Column {
    int x, y;
  };
  Column column_of(const Eigen::Vector3f& at) const {
    return {static_cast<int>(std::floor(at.x() / static_cast<float>(cell_))) + side_ / 2,
            static_cast<int>(std::floor(at.y() / static_cast<float>(cell_))) + side_ / 2};
  }

  double cell_;
  int side_;  // columns per side
  std::vector<CloudCell> cells_;
  std::vector<std::uint32_t> starts_;  // of each column
};

}  // namespace waymark::localization

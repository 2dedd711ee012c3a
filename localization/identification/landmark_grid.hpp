// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>
#include "localization/identification/map_landmark.hpp"
namespace waymark::localization {

/// Landmarks within this distance, m, decide together which doubtful ones are left out: about what a robot
/// sees at once.
inline constexpr double kOutweighedRadius = 30;

/// Landmarks in cells of a regular grid, in memory, for the many small queries of a particle filter: about
/// 40 ns each, whatever the size of the map. Immutable; several threads may query. Builds at 4 M
/// landmarks/s; each doubtful one costs a visit of its neighbours within kOutweighedRadius.
///
/// Marks as outweighed the landmarks whose confidence is below kLikelyExistence, but no lines. Others of
/// their type within kOutweighedRadius must be expected to be most of those that exist.
class LandmarkGrid {
 public:
  LandmarkGrid() = default;
  /// `cell` metres, > 0; 0: about two landmarks per cell. Orders landmarks by cell, row by row.
  explicit LandmarkGrid(std::vector<MapLandmark> landmarks, double cell = 0);

  std::span<const MapLandmark> landmarks() const { return landmarks_; }
  const MapLandmark& operator[](std::size_t i) const { return landmarks_[i]; }
  std::size_t size() const { return landmarks_.size(); }
  bool empty() const { return landmarks_.empty(); }
  Eigen::AlignedBox2d bounds() const { return bounds_; }
  double largest_sd() const { return largest_sd_; }            ///< of any landmark's position, m
  double max_half_length() const { return max_half_length_; }  ///< of any line, m; 0 without lines
  double min_quality() const { return min_quality_; }          ///< least `paper_quality`

  /// Returns the index of a landmark by key.
  std::optional<std::uint32_t> find(LandmarkKey key) const;

  /// Calls visit(index) for the landmarks within `radius` of `centre`, ascending.
  template <class Visit>
  void near(const Eigen::Vector2d& centre, double radius, Visit&& visit) const {
    if (landmarks_.empty()) return;
    const auto [c0, c1] = cells(centre.x() - bounds_.min().x(), radius, columns_);
    const auto [r0, r1] = cells(centre.y() - bounds_.min().y(), radius, rows_);
    if (c0 > c1) return;
    const double square = radius * radius;
    for (std::int64_t r = r0; r <= r1; ++r) {
      const std::uint32_t end = first_[static_cast<std::size_t>(r * columns_ + c1 + 1)];
      for (std::uint32_t i = first_[static_cast<std::size_t>(r * columns_ + c0)]; i < end; ++i) {
        const double dx = at_[i].x - centre.x(), dy = at_[i].y - centre.y();
        if (dx * dx + dy * dy <= square) visit(i);
      }
    }
  }

 private:
  struct XY {
    double x, y;
  };
  struct Range {
    std::int64_t first, last;
  };
  Range cells(double middle, double radius, std::int64_t count) const {
    const double low = (middle - radius) / cell_, high = (middle + radius) / cell_;
    if (!(high >= 0) || !(low < static_cast<double>(count))) return {1, 0};
    return {low > 0 ? static_cast<std::int64_t>(low) : 0,
            high < static_cast<double>(count - 1) ? static_cast<std::int64_t>(high) : count - 1};
  }

  void mark_outweighed();

  std::vector<MapLandmark> landmarks_;
  std::vector<XY> at_;                ///< positions of the landmarks, contiguous
  std::vector<std::uint32_t> first_;  ///< index of each cell's first landmark; one more than cells
  std::unordered_map<LandmarkKey, std::uint32_t> by_key_;
  Eigen::AlignedBox2d bounds_;
  double cell_ = 1, largest_sd_ = 0, min_quality_ = 1, max_half_length_ = 0;
  std::int64_t columns_ = 0, rows_ = 0;
};

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "localization/global/point_cells.hpp"
namespace waymark::localization {

/// Circular landmark of a map or a catalogue: the rim of a crater.
struct Circle {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< metres, or units of an unscaled map
  double diameter = 0;                           ///< in the same unit, > 0
  double position_sd = 0;                        ///< of each coordinate, > 0
  double log_diameter_sd = 0.1;                  ///< of the natural logarithm of the diameter, > 0
};

/// Similarity of the plane: catalogue = exp(log_scale) * turn(yaw) * map + shift.
struct PlaneSimilarity {
  double log_scale = 0, yaw = 0;  ///< yaw: radians, counterclockwise
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();

  Eigen::Matrix2d linear() const;  ///< scale and rotation
  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return linear() * p + shift; }
};

/// Similarity adjusted to the circles that agree with it.
struct CircleFit {
  PlaneSimilarity catalogue_from_map = {};
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero();  ///< of the covariance, in the catalogue
  /// Of the position of the pivot, the yaw about it (radians) and the logarithm of the scale.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::vector<std::optional<std::uint32_t>> matches = {};  ///< of each map circle, in the catalogue
  std::size_t matched = 0;
  double residual = 0;  ///< root mean square distance of the matches, metres
};

/// Compares circles of a map with those of a catalogue under a similarity. A circle of the map is one of the
/// K catalogue circles in view, each with equal probability, or clutter of uniform position (mixture model of
/// point registration; Myronenko & Song 2010). Immutable.
class CircleEvidence {
 public:
  CircleEvidence(std::span<const Circle> map, std::span<const Circle> catalogue);

  /// Returns ln of the probability density of the map at a place over that of clutter alone. It is averaged
  /// over fractions of true circles from 0.1 to 0.9.
  double log_ratio(const PlaneSimilarity& place) const;
  /// Returns a quick score of a place known by two matches at distance `base` (metres), for `count` circles.
  double quick_score(const PlaneSimilarity& place, const Eigen::Vector2d& between, double base,
                     std::size_t count) const;
  /// Adjusts by expectation and maximization; `std::nullopt` with fewer than three matches.
  std::optional<CircleFit> fit(PlaneSimilarity place) const;

  const std::vector<Circle>& map() const { return map_; }  ///< largest first
  const std::vector<Circle>& catalogue() const { return catalogue_; }
  const PointCells& cells() const { return cells_; }
  const Eigen::Vector2d& middle() const { return middle_; }  ///< of the map
  double extent() const { return extent_; }                  ///< of the map, diagonal of its box
  double catalogue_area() const { return catalogue_area_; }  ///< square metres

 private:
  struct Near {
    std::uint32_t index;
    double density, variance;
  };
  std::vector<Near> near(const Circle& circle, const PlaneSimilarity& place, double extra_variance) const;
  /// Returns the density of clutter in position and ln of the diameter, for a circle of the map.
  double clutter_density(std::size_t index, double scale) const;
  double in_view(const PlaneSimilarity& place) const;

  std::vector<Circle> map_, catalogue_;
  PointCells cells_;
  std::vector<double> clutter_;  // by circle of the map, at scale 1
  Eigen::Vector2d low_, high_, middle_;
  double extent_ = 0, map_area_ = 1, catalogue_area_ = 1, bandwidth_ = 0.2, largest_sd_ = 0;
};

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include "core/observation.hpp"
#include "pipeline/fusion/map_plane.hpp"
namespace waymark {

/// What tells things of one type apart: where one is and how large. An observation, or several of one thing.
struct Sighting {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();                ///< CRS units
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();    ///< east, north; square metres, definite
  double log_size = std::numeric_limits<double>::quiet_NaN();  ///< ln of the radius in metres; NaN: unknown
  double log_size_variance = 0;
  TypeId type = 0;
  std::uint32_t source = 0;  ///< image or survey
};

/// When two sightings may be the same thing.
struct IdentityRules {
  /// Limit of the squared Mahalanobis distance of the positions; 99.99 % of a chi-square of 2 degrees.
  double position_gate = 18.4;
  /// The same for ln(size), 1 degree.
  double size_gate = 15.1;
  /// Never further apart than this, metres, whatever the covariances say.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Things of different images, of like size, whose centres are nearer than this share of the smaller radius
  /// are one thing, whatever the covariances say: bodies do not stand inside each other.
  double overlap = 1;
  /// The same for two sightings of one image, which more likely are two things.
  double twin = 0.5;
  /// Sizes alike for that: larger / smaller.
  double alike = 1.5;
  /// Relative spread of a size beyond its measured error, from shape and light.
  double size_floor = 0.1;
};

/// How far the place may be from another of the same thing, the other's own reach added, metres.
double reach(const Sighting& sighting, const IdentityRules& rules);

/// Two sightings of one image, of like size, the centre of one well inside the other: IdentityRules::twin.
bool stand_in_each_other(const Sighting& a, const Sighting& b, const MapPlane& plane,
                         const IdentityRules& rules);

/// Twice the negative log likelihood that two sightings of one type and independent errors show one thing, up
/// to a constant: squared Mahalanobis distance + ln det of the summed covariance, and the same for ln(size).
/// The determinant keeps a vague sighting from being everybody's best match. Nothing where the rules say that
/// they differ.
std::optional<double> same_thing_cost(const Sighting& a, const Sighting& b, const MapPlane& plane,
                                      const IdentityRules& rules);

/// Both as one: information-weighted place and size. Keeps type and source of `a`.
Sighting fused(const Sighting& a, const Sighting& b, const MapPlane& plane);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include "core/observation.hpp"
#include "pipeline/fusion/association/map_plane.hpp"
namespace waymark::pipeline {

/// Position and size of a body, from one observation or several: the attributes by which bodies of one type
/// are associated.
struct ObservedObject {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();                ///< CRS units
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();    ///< east, north; square metres, definite
  double log_size = std::numeric_limits<double>::quiet_NaN();  ///< ln of the radius in metres; NaN: unknown
  double log_size_variance = 0;
  /// Azimuth of the first feature that is a direction, rad; NaN: none. Two faces of one wall differ by it.
  double direction = std::numeric_limits<double>::quiet_NaN();
  double direction_variance = 0;
  TypeId type = 0;
  std::uint32_t source = 0;  ///< image or survey
};

/// Rules for the association of two objects.
struct AssociationRules {
  /// Gate of the squared Mahalanobis distance of positions; 99.99 % of chi-square with 2 degrees of freedom.
  double position_gate = 18.4;
  /// Standard deviation of a position beyond its measured error, metres: of poses whose errors many
  /// observations share, so that fused positions look surer than they are.
  double position_floor = 0;
  /// Gate of the squared normalised difference of ln(size), 1 degree of freedom.
  double size_gate = 15.1;
  /// Gate of the squared normalised difference of directions, 1 degree of freedom.
  double direction_gate = 15.1;
  /// Standard deviation of a direction beyond its measured error, radians.
  double direction_floor = 0.05;
  /// Largest distance, metres, regardless of covariances.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Bodies of similar size in different images whose centres are nearer than this fraction of the smaller
  /// radius are one, regardless of covariances: bodies do not overlap.
  double overlap = 1;
  /// As `overlap`, for two objects of one image.
  double duplicate_overlap = 0.5;
  /// Largest ratio of similar sizes.
  double max_size_ratio = 1.5;
  /// Relative standard deviation of a size beyond its measured error, from shape and light.
  double size_floor = 0.1;
};

/// Returns the search radius, metres; two objects can be one if their distance is at most the sum of both.
double gate_radius(const ObservedObject& object, const AssociationRules& rules);

/// Returns whether two objects of one image have similar sizes and overlap within
/// AssociationRules::duplicate_overlap.
bool are_duplicates(const ObservedObject& a, const ObservedObject& b, const MapPlane& plane,
                    const AssociationRules& rules);

/// Returns twice the negative log likelihood that two independent objects of one type show one body, up to
/// a constant: squared Mahalanobis distance + ln det of the summed covariance, for position, direction and
/// ln(size).
/// The determinant keeps an uncertain object from being the best match of all others. `std::nullopt` if a
/// gate fails.
std::optional<double> association_cost(const ObservedObject& a, const ObservedObject& b,
                                       const MapPlane& plane, const AssociationRules& rules);

/// Returns the information-weighted mean of position, direction and size, with type and source of `a`.
ObservedObject fuse(const ObservedObject& a, const ObservedObject& b, const MapPlane& plane);

}  // namespace waymark::pipeline

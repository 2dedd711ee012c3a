// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>
#include "localization/horizon_profile.hpp"
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
#include "localization/pose2.hpp"
namespace waymark::localization {

/// Type of a sighting whose landmark type is not in the map.
inline constexpr TypeId kNoSuchType = 0xFFFF;

/// A landmark type that a sighting may be of, with its features in the order of that type.
struct PossibleType {
  TypeId type = 0;
  KnownFeatures features;
};

/// The seen piece of a straight line, such as a wall: from and to, m along the line from the foot of the
/// sensor on it. Positive is to the left of the normal that points to the sensor.
struct LineExtent {
  double from = 0, to = 0;
  double centre = 0;  ///< m, of the hits: a turn of the line about it does not change their distances
  /// Standard deviations, m at the centre and rad, by which a piece may deviate from the line of its wall.
  /// Each sighting of the piece has the same deviation, so the noise does not include it.
  double deviation_sd = 0, deviation_turn_sd = 0;
};

/// A sighting of one landmark: d in D of eq. 9. Bearings are radians from the sensor's x axis (forward) to
/// the left. Ranges are metres on the ground to the landmark's centre; cameras measure bearings alone,
/// radios ranges alone. Features are in the order of the type.
struct SeenLandmark {
  std::optional<TypeId> type;  ///< absent: one of `possible_types`, or any type if there are none
  std::optional<double> bearing = {};
  double bearing_sd = 0.02;  ///< rad; ignored without a bearing
  std::optional<double> range;
  double range_sd = 0.1;  ///< m; ignored without a range
  /// rad above the horizontal, of a summit on the horizon; absent otherwise. Needs a bearing.
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
  KnownFeatures features;               ///< of `type`; not compared without it
  std::optional<LandmarkKey> identity;  ///< of a landmark that identifies itself, e.g. a bar code
  double confidence = 1;                ///< probability that it is a landmark, (0, 1]
  /// Types between which the sensor cannot decide, without `type`. Their features have no angles.
  std::vector<PossibleType> possible_types = {};
  /// Of a line, whose range is that of its foot and whose bearing is absent: the feature `direction` of its
  /// type is measured instead.
  std::optional<LineExtent> extent = {};

  /// Returns whether range and bearing are measured, which give a position relative to the sensor.
  bool has_position() const { return range && bearing; }
  /// Returns whether every number can be used: finite, range > 0, standard deviations > 0. At least one of
  /// range and bearing is needed.
  bool is_valid() const;
  /// Returns whether its landmark may have this type.
  bool may_be(TypeId of) const;
  /// Returns whether its landmark may have any type.
  bool may_be_anything() const { return !type && possible_types.empty(); }
  /// Returns the features that a landmark of this type is compared with; null if there are none.
  const KnownFeatures* features_as(TypeId of) const;
};

/// Returns the types that a sighting may have; none if it may have any.
inline std::vector<TypeId> types_of(const SeenLandmark& seen) {
  if (seen.type) return {*seen.type};
  std::vector<TypeId> types;
  for (const PossibleType& possible : seen.possible_types) types.push_back(possible.type);
  return types;
}

/// Returns whether two sightings may be of one type. One that may be anything equals only another such.
bool may_share_type(const SeenLandmark& a, const SeenLandmark& b);

/// A range to an identified landmark, measured before at another place.
struct EarlierRange {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< place of the sensor, in the present frame of the robot
  /// Covariance of the motion since: displacement and turn about the present position. For two ranges, that
  /// of the later one is common to both.
  Eigen::Matrix3d motion = Eigen::Matrix3d::Zero();
  double range = 0, sd = 0.1;  ///< m
  LandmarkKey landmark = 0;
};

struct RangeProfile;

/// Sightings of one sensor at one time. They belong to different landmarks.
struct SightingSet {
  Pose2 robot_from_sensor;
  std::vector<SeenLandmark> sightings;
  std::vector<EarlierRange> earlier_ranges = {};  ///< for a PoseFinder only; the oldest first
  /// Of a panorama, from the robot's forward axis, for a PoseFinder only.
  std::shared_ptr<const HorizonProfile> horizon = {};
  std::shared_ptr<const RangeProfile> ranges = {};  ///< of a level line scan; null: what hides is not known
};

inline bool SeenLandmark::is_valid() const {
  if (!bearing && !range) return false;
  if (extent && !(range && !bearing && extent->to - extent->from > 0 && std::isfinite(extent->from) &&
                  std::isfinite(extent->to)))
    return false;
  if (elevation && !(bearing && std::abs(*elevation) < 1.6 && elevation_sd > 0)) return false;
  return confidence > 0 && confidence <= 1 &&
         (!bearing || (std::isfinite(*bearing) && std::isfinite(bearing_sd) && bearing_sd > 0)) &&
         (!range || (std::isfinite(*range) && *range > 0 && std::isfinite(range_sd) && range_sd > 0));
}

inline bool SeenLandmark::may_be(TypeId of) const {
  return may_be_anything() || features_as(of);
}

inline const KnownFeatures* SeenLandmark::features_as(TypeId of) const {
  if (type) return *type == of ? &features : nullptr;
  for (const PossibleType& possible : possible_types)
    if (possible.type == of) return &possible.features;
  return nullptr;
}

inline bool may_share_type(const SeenLandmark& a, const SeenLandmark& b) {
  if (a.may_be_anything() || b.may_be_anything()) return a.may_be_anything() && b.may_be_anything();
  if (a.type) return b.may_be(*a.type);
  return std::ranges::any_of(a.possible_types, [&](const PossibleType& p) { return b.may_be(p.type); });
}

}  // namespace waymark::localization

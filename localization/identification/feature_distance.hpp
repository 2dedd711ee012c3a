// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <vector>
#include "landmarks/landmark_type.hpp"
#include "localization/absolute_fix.hpp"
#include "localization/identification/known_features.hpp"
#include "localization/identification/map_landmark.hpp"
namespace waymark::localization {

/// Scale of each feature, by TypeId and index of the feature, and identification reach of each type.
class FeatureScales {
 public:
  FeatureScales() = default;
  explicit FeatureScales(const TypeRegistry& types);
  /// Returns a - b, the short way round for an axis or a direction. Types beyond the registry count as ratio.
  double difference(TypeId type, std::size_t feature, double a, double b) const;
  /// Returns whether a feature is an angle, which turns with the sensor: an axis or a direction.
  bool is_angle(TypeId type, std::size_t feature) const {
    return type < scales_.size() && waymark::is_angle(scales_[type][feature]);
  }
  /// Returns whether the type has features that are angles.
  bool has_angles(TypeId type) const;
  /// Returns the period of an angle, 0 for other features.
  double period(TypeId type, std::size_t feature) const {
    return type < scales_.size() ? waymark::period(scales_[type][feature]) : 0;
  }
  /// Returns the standard deviation of a feature between two sensors: the fraction `tolerance` of its value,
  /// or of its reference for an angle, whose value has no size.
  double tolerance_sd(TypeId type, std::size_t feature, double value, double tolerance) const;
  /// Returns LandmarkType::identification_reach. Without a type the smallest of the registry, so that one
  /// type with a far reach does not make all landmarks candidates; 100 m for an empty registry.
  double identification_reach(std::optional<TypeId> type) const;

  /// Returns the features of a type whose landmarks are lines; `std::nullopt` for other types.
  std::optional<LineFeatures> line(TypeId type) const {
    return type < lines_.size() ? lines_[type] : std::nullopt;
  }

  /// Returns alpha_f of eq. 11, which is the same for all landmarks of a type. Unless it was set, one over
  /// the feature's reference, or over `tolerance` times the geometric mean of its plausible range.
  double alpha(TypeId type, std::size_t feature, double tolerance) const;
  /// Sets alpha_f of eq. 11, per unit of the feature. Throws std::out_of_range for an unknown type.
  void set_alpha(TypeId type, std::size_t feature, double alpha);

 private:
  struct Weight {
    double alpha = 0;      // 0: by the two others
    double reference = 0;  // 0: none
    double typical = 1;
  };
  std::vector<std::array<Scale, kMaxFeatures>> scales_;
  std::vector<double> reaches_;
  std::vector<std::optional<LineFeatures>> lines_;
  std::vector<std::array<Weight, kMaxFeatures>> weights_;
};

/// Returns the features of a sighting as a map states them: angles, which a sensor measures from its x axis
/// to the left, become azimuths clockwise from the map's north. `sensor_yaw`, rad, has variance
/// `yaw_variance`.
KnownFeatures features_in_map(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                              double sensor_yaw, double yaw_variance = 0);

/// Returns the features that do not depend on the heading of the sensor: all but angles.
KnownFeatures features_without_angles(const FeatureScales& scales, TypeId type, KnownFeatures seen);

/// Heading measured by a feature that is an angle.
struct AngleFix {
  HeadingFix heading;
  double period = 0;  ///< of the feature, rad
};

/// Returns the yaws of the sensor that the angles of a sighting measure if it shows `mapped`, a landmark of
/// the map; an axis allows two, and gives the nearer to `sensor_yaw`. The variances are those of both angles
/// and the tolerance between sensors.
std::vector<AngleFix> yaws_from_angles(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                       const KnownFeatures& mapped, double sensor_yaw, double tolerance);

/// Sets alpha_f of eq. 11 from a list as "rock.radius=4,rock.height=2". Throws Error{usage} for an unknown
/// type or feature, and for a value that is not positive.
void set_alphas(FeatureScales& scales, const TypeRegistry& types, std::string_view list);

/// Agreement of the features of a sighting with those of a landmark.
struct FeatureComparison {
  double squares = 0;           ///< sum of squared differences over their variances
  int used = 0;                 ///< features known on both sides
  int missing = 0;              ///< features of the sighting that the landmark lacks
  double largest = 0;           ///< largest single squared difference over its variance
  double weighted_squares = 0;  ///< sum of squared alpha_f times the difference (eq. 11)
  double largest_weighted = 0;  ///< largest single term of it
};

/// Compares a sighting's features with those of a landmark of the same type. `tolerance`: relative standard
/// deviation between two sensors; keeps variances above 0.
FeatureComparison compare_features(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                   const KnownFeatures& mapped, double tolerance);

}  // namespace waymark::localization

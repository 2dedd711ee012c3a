// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <vector>
#include "landmarks/landmark_type.hpp"
#include "localization/identification/known_features.hpp"
namespace waymark::localization {

/// Scale of each feature, by TypeId and index of the feature, and identification reach of each type.
class FeatureScales {
 public:
  FeatureScales() = default;
  explicit FeatureScales(const TypeRegistry& types);
  /// Returns a - b, the short way round for an axis. Types beyond the registry count as ratio.
  double difference(TypeId type, std::size_t feature, double a, double b) const;
  /// Returns whether a feature is a direction, and whether the type has any.
  bool is_axis(TypeId type, std::size_t feature) const {
    return type < scales_.size() && scales_[type][feature] == Scale::axis;
  }
  bool has_axis(TypeId type) const;
  /// Returns LandmarkType::identification_reach. Without a type the smallest of the registry, so that one
  /// type with a far reach does not make all landmarks candidates; 100 m for an empty registry.
  double identification_reach(std::optional<TypeId> type) const;

 private:
  std::vector<std::array<Scale, kMaxFeatures>> scales_;
  std::vector<double> reaches_;
};

/// Returns the features of a sighting as a map states them: axes, which a sensor measures from its x axis to
/// the left, become azimuths clockwise from the map's north. `sensor_yaw`, rad, has variance `yaw_variance`.
KnownFeatures features_in_map(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                              double sensor_yaw, double yaw_variance = 0);

/// Returns the features that do not depend on the heading of the sensor: all but axes.
KnownFeatures features_without_axes(const FeatureScales& scales, TypeId type, KnownFeatures seen);

/// Agreement of the features of a sighting with those of a landmark.
struct FeatureComparison {
  double squares = 0;  ///< sum of squared differences over their variances
  int used = 0;        ///< features known on both sides
  int missing = 0;     ///< features of the sighting that the landmark lacks
  double largest = 0;  ///< largest single squared difference over its variance
};

/// Compares a sighting's features with those of a landmark of the same type. `tolerance`: relative standard
/// deviation between two sensors; keeps variances above 0.
FeatureComparison compare_features(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                   const KnownFeatures& mapped, double tolerance);

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>
#include "landmarks/landmark_type.hpp"
#include "localization/identification/known_features.hpp"
namespace waymark {

/// How the features of each type are compared: scale, by TypeId and index of the feature.
class FeatureScales {
 public:
  FeatureScales() = default;
  explicit FeatureScales(const TypeRegistry& types);
  /// a - b; the short way round for an axis. Types beyond the registry count as ratio.
  double difference(TypeId type, std::size_t feature, double a, double b) const;

 private:
  std::vector<std::array<Scale, kMaxFeatures>> scales_;
};

struct FeatureComparison {
  double squares = 0;  ///< sum of squared differences over their variances
  int used = 0;        ///< features known on both sides
  int missing = 0;     ///< features of the sighting that the landmark lacks
  double largest = 0;  ///< largest single squared difference over its variance
};

/// Compares a sighting's features with a landmark's of the same type. `tolerance`: part of the value two
/// sensors may disagree by, one standard deviation; keeps variances above 0.
FeatureComparison compare_features(const FeatureScales& scales, TypeId type, const KnownFeatures& seen,
                                   const KnownFeatures& mapped, double tolerance);

}  // namespace waymark

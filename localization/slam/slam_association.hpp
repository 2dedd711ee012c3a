// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>
#include "localization/filters/measurement.hpp"
#include "localization/sighting.hpp"
#include "localization/slam/slam_landmark.hpp"
#include "localization/slam/slam_options.hpp"
namespace waymark::localization {

/// A landmark with which the sightings of a set are compared.
struct SlamCandidate {
  std::size_t landmark = 0;
  bool is_expected = false;   ///< it is in view and near: the sensor should see it if it exists
  ExpectedSighting sighting;  ///< at the estimated pose
  Eigen::Matrix2d
      covariance;  ///< of `sighting` by the errors of pose and landmark, without the sensor's noise
  /// Where pieces of a line may lie, from the foot of the sensor on it; absent for a point.
  std::optional<LineExtent> extent = {};
  bool is_in_view = false;  ///< within the range and view that the sensor has shown, and not hidden
};

/// A sighting and the landmark that it may show.
struct SlamPair {
  double squares = 0;  ///< squared Mahalanobis distance, features included
  std::size_t sighting = 0, landmark = 0;
};

/// What the candidates say about one sighting.
struct SlamComparison {
  double min_squares = 1e9;      ///< squared Mahalanobis distance of the nearest candidate
  double min_distance = 1e9;     ///< m to the nearest candidate; 0 if its identity is known
  bool features_differ = false;  ///< a candidate was excluded by its features
};

/// All pairs inside their gates, and a comparison for each sighting.
struct SlamPairs {
  std::vector<SlamPair> pairs;
  std::vector<SlamComparison> comparisons;
};

/// Returns whether the identity of a sighting is known and used.
inline bool is_identified(const SeenLandmark& seen, const SlamOptions& options) {
  return options.identification.use_identities && seen.identity;
}

/// Returns whether SLAM uses a sighting. A beacon that identifies itself is heard farther than landmarks are
/// seen.
bool is_usable(const SeenLandmark& seen, const SlamOptions& options);

/// Compares each usable sighting with each candidate. A landmark of the map is paired only with a sighting
/// that `in_map` identifies as it; an identity is compared with its own landmark alone. O(sightings *
/// candidates).
SlamPairs compare_with_landmarks(std::span<const SeenLandmark> seen,
                                 std::span<const SlamCandidate> candidates,
                                 std::span<const SlamLandmark> landmarks,
                                 std::span<const std::optional<LandmarkKey>> in_map,
                                 const FeatureScales& scales, const SlamOptions& options);

/// Returns pairs in which each sighting and each landmark occurs once, smallest distance first.
std::vector<SlamPair> pair_one_to_one(std::vector<SlamPair> pairs);

/// Removes the pair without which the others agree best, until they agree: pairs of a set share the error of
/// the pose (joint compatibility, Neira & Tardos 2001; here greedily). `corrections`: those of the pairs, in
/// the same order. O(n^5) at worst, O(n^3) if all agree.
void remove_incompatible(const SlamState& state, std::span<const SeenLandmark> seen,
                         std::vector<SlamPair>& pairs, std::vector<SlamState::Correction>& corrections);

}  // namespace waymark::localization

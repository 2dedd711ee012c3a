// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::pipeline {

/// What two maps know in common of a landmark.
struct CommonEvidence {
  int observations = 0;  ///< that support it in both maps
  int sources = 0;       ///< images or surveys that support it in both maps
  int missed = 0;        ///< images of both maps that cover it and support it in neither
  int found_by_a = 0;    ///< images of both maps that support it in map a only; map b counts them as missed
  int found_by_b = 0;    ///< the same for map b
  /// Ground sample distance of the finest image that supports it, metres; infinity: no image does.
  double finest_gsd = std::numeric_limits<double>::infinity();
};

/// Returns a landmark as an observation by its map: position, covariance, features and confidence. `source`
/// names the map.
Observation as_observation(const Landmark& landmark, const std::string& source);

/// Fuses one landmark of two maps, as if their observations were merged at once.
/// - Position: merge_as_one(); a map with unknown covariance counts only if both are unknown. Observations in
///   common leave the covariance at that of the surer map.
/// - Features: eq. 3 over the observations of both; q_f and deviation by the spread of all of them.
/// - Counts: images and surveys in common count once. Existence: log odds of both maps by
///   existence_probability(); the larger confidence if they have observations in common.
/// - uid and attributes: of the landmark with more observations, else of `a`.
Landmark fuse_landmarks(const Landmark& a, const Landmark& b, const CommonEvidence& common,
                        const TypeRegistry& types, const Crs& crs);

}  // namespace waymark::pipeline

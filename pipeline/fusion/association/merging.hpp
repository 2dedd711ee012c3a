// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "core/observation_order.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/observed_object.hpp"
namespace waymark::pipeline {

/// Weight of an observation in a merged feature.
enum class FeatureWeights {
  quality,    ///< eq. 3 literally: q(d)
  precision,  ///< q(d) / variance of the measurement, if every observation has one
};

struct MergeRules {
  AssociationRules association;
  FeatureWeights weights = FeatureWeights::quality;
  /// Lower limit of the standard deviation of a position: metres, and as a fraction of the body's radius.
  double min_sd = 0.01, min_sd_per_radius = 0.03;
  /// Fraction of a position's variance common to all images of a landmark (shape, light, DEM), [0, 1]; more
  /// images do not reduce it.
  /// Measured as correlation between the errors of different images of a rock: 0.71 to 0.78 on landings 303,
  /// 401, 402 and 512 (docs/evaluation/2026-11-22-position-covariances.md). 0.15 suits simulated detectors
  /// with independent errors.
  double common_fraction = 0.75;
};

struct MergedObservations {
  std::vector<Landmark> landmarks;    ///< by type and position, with uids, without quality
  std::vector<Observation> evidence;  ///< all inputs by content; accepted ones name their landmark
};

/// Merges observations into landmarks (Rossmann et al. 3.2, eqs. 1-3).
/// - Association (same type, different sources) is done by pipeline/fusion/association/clustering.hpp.
/// - Features are merged by eq. 3 according to their scale (core/feature.hpp).
/// - Departure: positions are weighted by inverse covariances, not by q(d), since images of a descent differ
///   tenfold in sharpness.
/// - Duplicates of a more confident observation of the same source are rejected as "seen twice in one image".
///   Rejected observations pass through.
/// Sources are treated as independent. The result is bit-identical for any order of observations and any
/// number of threads.
MergedObservations merge_observations(std::vector<Observation> observations, const TypeRegistry& types,
                                      const Crs& crs, const MergeRules& rules = {});

/// Returns for each observation the index of the first one of the same landmark, by the association of
/// merge_observations(). Observations of one source are different landmarks. For equal costs the result
/// depends on the order.
std::vector<std::uint32_t> associate(std::span<const Observation> observations, const TypeRegistry& types,
                                     const Crs& crs, const AssociationRules& rules = {});

/// Merges observations of one landmark, at least one, as merge_observations() does: position, covariance and
/// features.
Landmark merge_as_one(std::span<const Observation> members, const TypeRegistry& types, const Crs& crs,
                      const MergeRules& rules = {});

}  // namespace waymark::pipeline

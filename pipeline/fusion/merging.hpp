// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/sighting.hpp"
namespace waymark {

/// What an observation counts in a merged feature.
enum class FeatureWeights {
  quality,    ///< eq. 3 literally: q(d)
  precision,  ///< q(d) / variance of the measurement, where every observation tells it
};

struct MergeRules {
  IdentityRules identity;
  FeatureWeights weights = FeatureWeights::quality;
  /// Least standard deviation of a place that is believed: metres, and as a share of the body's radius.
  double least_sd = 0.01, least_sd_of_radius = 0.03;
  /// Share of a position's variance that all images of a landmark have in common (shape, light, DEM), so that
  /// more images do not reduce it, [0, 1]: the correlation between the errors of different images of one
  /// rock, in standard deviations, 0.71 to 0.78 on landings 303, 401, 402 and 512 (docs/qualities.md). 0.15
  /// is enough for made detectors whose errors are independent.
  double common_share = 0.75;
};

struct MergedObservations {
  std::vector<Landmark> landmarks;    ///< by type and position; uids given, not yet valued
  std::vector<Observation> evidence;  ///< all that went in, by content; kept ones name their landmark
};

/// Makes landmarks of observations (Rossmann et al. 3.2, eqs. 1-3). Same type, different sources; which ones
/// belong together is decided by pipeline/fusion/clustering.hpp. Features are merged by eq. 3 in the sense of
/// their scale (core/feature.hpp). Departure: a position is the mean weighted by inverse covariances, not by
/// q(d), since images of a descent differ tenfold in sharpness; its covariance follows.
/// An observation that stands in the place of a more confident one of its own source (two detectors, one
/// thing) is rejected as "seen twice in one image". Rejected observations pass through.
/// Observations of one source are independent of those of another; the same set of observations in any order
/// gives the same result, bit for bit, with any number of threads.
MergedObservations merge_observations(std::vector<Observation> observations, const TypeRegistry& types,
                                      const Crs& crs, const MergeRules& rules = {});

/// The order of content: type, source, place, then all else. Equal only if no member tells them apart.
bool comes_before(const Observation& a, const Observation& b);

}  // namespace waymark

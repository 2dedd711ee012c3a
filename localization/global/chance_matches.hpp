// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
namespace waymark::localization {

/// A sighting compared with the landmarks about its position at an assumed pose.
struct ChanceMatch {
  double probability = 0;  ///< that some landmark matches it by chance
  bool is_matched = false;
  double squares = 0;  ///< squared Mahalanobis distance of its match, at most `gate`
};

/// Returns the probability that independent sightings match by chance as well as these (a contrario;
/// Desolneux, Moisan & Morel 2000). A chance match lies anywhere in its gate, a true one near the middle:
/// each match counts by the ratio of the two densities, and by one of two weights. The result is twice the
/// smaller of two tails, as two are tried:
/// - equal weights, which are strong if the map lacks many of the objects seen, the rare ones too;
/// - the information -ln(probability), at most 12: one rare landmark counts for several common ones.
///
/// `gate`: largest squared distance of a match. Sums are computed in steps of half a nat.
double chance_of_matches(std::span<const ChanceMatch> sightings, double gate);

}  // namespace waymark::localization

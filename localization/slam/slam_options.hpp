// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/options.hpp"
#include "localization/identification/identification.hpp"
namespace waymark::localization {

/// Options of EKF SLAM.
struct SlamOptions {
  double match = 9.21;    ///< gate: squared Mahalanobis distance up to which a sighting matches
  double fresh = 25;      ///< distance beyond which it is a new landmark; between the two it is ambiguous
  double nearest = 2;     ///< m: smallest distance of a new landmark to another
  double max_range = 40;  ///< m; sightings farther away are not used
  double seen = 0.85;     ///< log odds that a match adds to a landmark's existence
  double unseen = -0.5;   ///< log odds, at most, that a missed detection adds
  double confirmed = 2;   ///< log odds from which a landmark is written to a map
  double dropped = -1;    ///< log odds below which it is removed
  double field_of_view = 1.4;            ///< rad to each side where sightings are expected
  double margin = 15;                    ///< m driven between two updates of the landmarks out of sight
  double feature_tolerance = 0.15;       ///< relative standard deviation between two sightings
  double feature_limit = 9;              ///< squared standard deviations by which a feature may differ
  IdentificationOptions identification;  ///< its quality floor and use of identities; described by its owner

  void describe(OptionVisitor& option);
};

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/horizon_profile.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Options of the summit detector for horizon profiles.
struct HorizonSummitOptions {
  std::optional<TypeId> type;     ///< of the sightings
  double min_prominence = 0.006;  ///< rad above both sides before the horizon is higher
  double min_distance = 0;        ///< rad, to a higher summit
};

/// A summit on the horizon.
struct DetectedSummit {
  double bearing = 0, elevation = 0;  ///< rad
  double prominence = 0;              ///< rad
  double bearing_sd = 0.01;
};

/// Finds prominent local maxima of the horizon, the most prominent first. A full turn is treated as a ring.
/// The bearing is that of a parabola through the maximum and its neighbours.
std::vector<DetectedSummit> find_summits(const HorizonProfile& horizon, const HorizonSummitOptions& options);

/// Finds summits and returns them as sightings without range: the distance of a summit is not measured.
SightingSet sightings_of_summits(const HorizonProfile& horizon, const HorizonSummitOptions& options);

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "localization/sighting.hpp"
namespace waymark {

/// Where the ground ends and the sky begins, all round or in part.
struct HorizonProfile {
  double first_angle = 0, angle_step = 0;  ///< rad, left of forward
  double elevation_sd = 0.001;             ///< rad
  std::vector<float> elevations;           ///< rad; not finite: not known
};

struct HorizonSummits {
  std::optional<TypeId> type;       ///< given to the sightings
  double least_prominence = 0.006;  ///< rad that it stands above both sides before the horizon is higher
  double least_distance = 0;        ///< rad, to a higher summit
};

/// A summit on the horizon.
struct SeenSummit {
  double bearing = 0, elevation = 0;  ///< rad
  double prominence = 0;              ///< rad
  double bearing_sd = 0.01;
};

/// Local maxima of the horizon that stand out; the highest first. A full turn is taken as a ring. The place
/// is that of a parabola through the highest and its neighbours.
std::vector<SeenSummit> find_summits(const HorizonProfile& horizon, const HorizonSummits& options);

/// Bearings only: the map does not say how far they are.
SightingSet sightings_of_summits(const HorizonProfile& horizon, const HorizonSummits& options);

}  // namespace waymark

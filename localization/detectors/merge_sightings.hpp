// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/identification/feature_distance.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Returns one sighting for each object that several detectors found in one scan. Sightings of different
/// sets are of one object if their centres are nearer than two objects that a detector can separate. If the
/// types differ, the type is left open among them; position and errors are those of the least certain range.
SightingSet merge_sightings(std::span<const SightingSet> sets, const FeatureScales& scales);

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/identification/feature_distance.hpp"
#include "workflows/mapping/drive_looks.hpp"
namespace waymark::workflows {

/// Returns whether a sighting is a piece of a line, known across itself (docs/decisions/0038): it has an
/// extent, and a type with a direction and a length.
bool is_piece_of_line(const localization::SeenLandmark& seen, const TypeRegistry& types);

/// Returns the sighting of a line as an observation of a point: the middle of its piece, whose covariance is
/// long along it.
Observation observation_of_line(const localization::SeenLandmark& seen, const DriveLook& look,
                                const TypeRegistry& types, const localization::FeatureScales& scales,
                                const DriveMappingOptions& options);

/// Unites the pieces of each line, so that they are observations of one landmark; other observations stay.
/// - Pieces are of one line within 0.15 rad and 0.4 m, with gaps of 1.5 m or less, in any order.
/// - Each is moved along the line to the middle of their union, and gets its length.
/// - Pieces of one source become one observation. One that deviates by more than it states gets that
/// variance.
/// - Cost: pieces times lines.
void unite_lines(std::vector<Observation>& observations, const TypeRegistry& types);

/// Restores what the mean of many pieces lost: the position of a line along itself is not known.
void widen_line(Landmark& landmark, const LandmarkType& type);

}  // namespace waymark::workflows

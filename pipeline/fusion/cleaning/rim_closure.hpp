// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "core/observation.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
namespace waymark::pipeline {

/// Returns the height of a rim above its floor, in diameters, that most azimuths reach: the 15th percentile
/// of the crest over 36 azimuths (0.9 to 1.2 radii) minus the lowest fifth of the floor.
/// Both are measured above the plane of the surroundings, so slopes, scarps and valleys give about 0.
/// Returns `std::nullopt` below three cells of the terrain or if heights are unknown.
std::optional<double> rim_closure(const Terrain& terrain, const GroundOutline& outline);

/// Updates the confidences of crater observations of one image by their heights. Positions are in units of
/// `metres_per_unit`.
/// - The weight of the heights is estimated from the same observations: separation of the rims of probable
///   craters and probable false detections against their spread.
/// - Prior means count as five observations. If heights do not separate the two kinds, nothing changes.
void update_crater_confidences(std::span<Observation> observations, const TypeRegistry& types,
                               const Terrain& terrain, double metres_per_unit);

}  // namespace waymark::pipeline

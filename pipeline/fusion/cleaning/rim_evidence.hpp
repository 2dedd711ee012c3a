// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "core/observation.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/projection/ground_outline.hpp"
namespace waymark::pipeline {

/// Shape of the ground along a supposed rim, above the plane of its surroundings. Slopes, scarps and valleys
/// have a low `evenness`, hollows without a rim a low `raised`.
struct RimShape {
  double depth = 0;     ///< median crest (0.9 to 1.2 radii) minus the lowest fifth of the floor, diameters
  double evenness = 0;  ///< lowest twentieth of the crest over the floor, fraction of the depth, -1 to 1
  double raised = 0;  ///< median crest over the ground at 1.5 radii and more, fraction of the depth, -1 to 1
};

/// Measures the heights along 36 azimuths. `std::nullopt` below three cells of the terrain or if heights are
/// unknown.
std::optional<RimShape> measure_rim_shape(const Terrain& terrain, const GroundOutline& outline);

/// Returns the log of the ratio of likelihoods, crater over no crater, of a rim in heights that resolve it.
/// Fitted to simulated landings (docs/evaluation/2026-11-27-craters-on-landings.md).
double crater_log_odds(const RimShape& rim);

/// Updates the confidences of crater observations of one image by their heights. Positions are in units of
/// `metres_per_unit`.
/// - The weight of the heights is estimated from the same observations: separation of the log odds of
///   probable craters and probable false detections against their spread.
/// - The mean of all counts as five observations of either kind. If heights do not separate the two kinds,
///   nothing changes.
void update_crater_confidences(std::span<Observation> observations, const TypeRegistry& types,
                               const Terrain& terrain, double metres_per_unit);

}  // namespace waymark::pipeline

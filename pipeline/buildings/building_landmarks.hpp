// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/buildings/building_outline.hpp"
#include "pipeline/buildings/find_buildings.hpp"
#include "pipeline/buildings/find_poles.hpp"
namespace waymark::pipeline {

/// How walls are derived of roofs. Metres.
struct WallRules {
  double overhang = 0;       ///< of the roofs beyond the walls: walls and corners are moved in by it
  double overhang_sd = 0.3;  ///< what is not known of it. Assumed: eaves of 0 to 1 m
  double survey_sd = 0.1;    ///< of the survey as a whole, along each axis
  double min_length = 2;     ///< of a wall
};

/// Landmarks with one observation each, by type and position, and outlines.
struct BuildingLandmarks {
  std::vector<Landmark> landmarks;
  std::vector<Observation> evidence;
  std::vector<BuildingOutline> footprints;
};

/// Returns a `building` for each building, with a `wall` for each wall and a `wall_corner` for each corner of
/// a regular outline.
/// - They are derived as `waymark import` derives them of polygons (geo/outline_shapes.hpp).
/// - Walls are known across their direction only.
/// - Positions lie at the foot: z is the ground, or 0 with variance NaN.
BuildingLandmarks building_landmarks(std::span<const DetectedBuilding> buildings, const CanopySource& canopy,
                                     const TypeRegistry& types, const WallRules& rules);

/// Returns a `pole` for each pole, with height but without diameter: a few returns do not give it.
BuildingLandmarks pole_landmarks(std::span<const DetectedPole> poles, const CanopySource& canopy,
                                 const TypeRegistry& types, double survey_sd);

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>
#include "core/observation.hpp"
#include "geo/crs.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/cleaning/shaded_by_relief.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

// Cleaning (Rossmann et al. 3.2). Each function marks observations with a reason and skips marked ones.

struct PlausibilityRules {
  /// Smallest accepted depth / diameter of a bowl, with a tolerance of two standard deviations.
  double min_depth_ratio = 0.01;
  /// Largest accepted height / diameter of a shadow caster. Taller ones are cliffs and
  /// ridges.
  double max_height_ratio = 3;
};

/// Rejects features outside the range of their type ("implausible radius"), bowls with "negative depth" or
/// "too shallow", and shadow casters that are "too tall".
void reject_implausible(std::span<Observation> observations, const TypeRegistry& types,
                        const PlausibilityRules& rules = {});

struct TerrainShadowRules {
  double min_distance_cells = 2;  ///< smallest distance between object and shadowing terrain
  ReliefRules relief = {};
};

/// Rejects shadow casters detected by darkness that the terrain explains, even with the sun one standard
/// deviation higher. `image` is the source of all observations; without sun nothing is rejected. Positions in
/// units of a CRS of `metres_per_unit`.
/// - "in the terrain's shadow": terrain beyond the object shades the centre of the assumed shadow.
/// - "dark by the terrain's relief": explained_by_relief().
void reject_terrain_shadows(std::span<Observation> observations, const TypeRegistry& types,
                            const ImageView& image, const Terrain& terrain, double metres_per_unit,
                            const TerrainShadowRules& rules = {});

struct RimShadowRules {
  double inner = 0.55, outer = 1.2;  ///< band around the rim, in radii of the ellipse in the rock's direction
  double half_angle = 1.4;           ///< radians to either side of the sun's direction, at the centre
  double min_fraction = 0.12;        ///< rocks narrower than this fraction of the crater are kept
  double min_confidence = 0.5;       ///< of the crater
};

/// Rejects shadow casters on the light-facing rim of a bowl, where the shadow is the bowl's: rocks and
/// craters for short. Such a rock lies towards the sun from the crater's centre, at about the elliptic
/// radius. Craters of all images and DEMs count (`craters` may be the same list); the sun is that of the
/// rock's image.
void reject_rim_shadows(std::span<Observation> observations, std::span<const Observation> craters,
                        const TypeRegistry& types, const std::map<std::string, Sun>& sun_of_image,
                        const Crs& crs, const RimShadowRules& rules = {});

}  // namespace waymark::pipeline

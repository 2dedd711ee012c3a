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
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

// Cleaning (Rossmann et al. 3.2). Each marks observations with a reason and leaves marked ones alone.

struct PlausibilityRules {
  /// Shallowest crater that is believed: depth / diameter. Two standard deviations in its favour.
  double min_depth_ratio = 0.01;
  /// Tallest thing told by its shadow that is believed: height / diameter. Taller ones are cliffs and ridges.
  double max_height_ratio = 3;
};

/// Features outside the range that the type declares ("implausible radius"), craters whose floor lies above
/// their rim ("negative depth") or hardly below it ("too shallow"), rocks that would be needles ("too tall").
void reject_implausible(std::span<Observation> observations, const TypeRegistry& types,
                        const PlausibilityRules& rules = {});

struct TerrainShadowRules {
  double min_distance_cells = 2;  ///< what casts the shadow stands at least so far from the thing
};

/// Things told by their shadow where the terrain itself keeps the sun away, even with the sun a standard
/// deviation higher: the middle of the assumed shadow is looked at. `image` is where all of them were seen;
/// without sun nothing is rejected. Positions in units of a CRS of `metres_per_unit`.
void reject_terrain_shadows(std::span<Observation> observations, const TypeRegistry& types,
                            const ImageView& image, const Terrain& terrain, double metres_per_unit,
                            const TerrainShadowRules& rules = {});

struct RimShadowRules {
  double inner = 0.55, outer = 1.2;  ///< band about the rim, in radii of the ellipse in the rock's direction
  double half_angle = 1.4;           ///< radians either side of the sun's direction, seen from the middle
  double min_share = 0.12;      ///< rocks narrower than this share of the crater stay: a rim's shadow is wide
  double min_confidence = 0.5;  ///< of the crater
};

/// Rocks on or near the light-facing rim of a crater: their "shadow" is the crater's. The rock lies in the
/// direction of the sun from the crater's middle, at about the elliptic radius in that direction. Craters of
/// all images and of DEMs count (`craters` may be the same list); the sun is that of the rock's own image.
void reject_rim_shadows(std::span<Observation> observations, std::span<const Observation> craters,
                        const TypeRegistry& types, const std::map<std::string, Sun>& sun_of_image,
                        const Crs& crs, const RimShadowRules& rules = {});

}  // namespace waymark

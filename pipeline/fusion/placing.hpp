// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/detection.hpp"
#include "core/observation.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/sight.hpp"
namespace waymark {

/// What is not told by images and terrain.
struct PlacingRules {
  double height_sd = 0;       ///< metres, of the terrain where it does not tell its own
  bool heights_known = true;  ///< false: the terrain is a plane somebody assumed, so places have no height
  double slope_sd = 0.03;     ///< of the ground under a rock against the terrain's, metres per metre
  /// How far from the crest towards the place where brightness changes fastest the outlines of craters lie
  /// (crest_by_wear.hpp): 1 for a detector of edges, 0 for one that tells crests. Ours begins at the edge and
  /// goes 0.35 of the way to what its model takes for the crest (bowl_verification.cpp).
  double edge_share = 0.65;
  /// Standard deviation of a centre from the shape of the thing, as a share of its diameter: along the sun
  /// for things told by their shadow (how far under its top a rock begins), all round for rims.
  double shadow_shape = 0.1, rim_shape = 0.035;
};

/// A detection on the ground: the line of sight of its centre meets the terrain, its outline is laid on the
/// tangent plane there (for a crater of four cells and more: on the plane through its rim), and the type's
/// features are measured in metres as seen from above: radius, major_axis, minor_axis, orientation, diameter,
/// crown_diameter; height from the shadow; depth from the terrain. Craters are as wide as their crests where
/// the terrain shows how worn they are. Features that cannot be measured are absent. Observation::position is
/// in the grid frame (metres); the stage turns it into the map's units. Covariance = image + pose + terrain
/// height along the line of sight + shape; the feature variances are of the measurement. Where no ground is
/// seen, `rejected` tells why and the position is NaN.
Observation placed(const Detection& detection, const ImageView& image, const Terrain& terrain,
                   const LandmarkType& type, const PlacingRules& rules);

}  // namespace waymark

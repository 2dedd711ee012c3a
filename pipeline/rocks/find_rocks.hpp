// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/rocks/light_coherence.hpp"
#include "pipeline/rocks/relief_displacement.hpp"
#include "pipeline/rocks/shaded_ground.hpp"
#include "pipeline/vision/sun_angle.hpp"
namespace waymark::pipeline {

/// How rocks are found.
enum class RockMethod {
  shadow,   ///< shadow fraction over the local ground, inverted by a rendered table (docs/methods/rocks.md)
  classic,  ///< maximum entropy threshold and ellipse, as Golombek et al. 2008 and ROSCO
};

/// Parameters of the rock search in one image.
struct RockSearch {
  RockMethod method = RockMethod::shadow;
  TypeId type = 0;  ///< id of the landmark type `rock`, copied into the detections
  /// Towards the sun in the image, from x (right) towards y (down). Unset: estimate_rock_sun_angle.
  std::optional<Radians> sun_angle = {};
  /// Direction that the craters of the image show (estimate_crater_sun_angle, its count as `shadows`). Used
  /// if `sun_angle` is unset: hollows look like rocks under the opposite sun.
  std::optional<SunAngle> crater_sun = {};
  /// Above the horizon. Unset: 40 degrees are assumed; outlines and `shadow_reach` depend on it weakly, and
  /// their standard deviations allow for that. Heights need the true value.
  std::optional<Radians> sun_elevation = {};
  /// Relief displacement of an oblique view. Unset: vertical view.
  std::optional<ReliefDisplacement> displacement = {};
  double blur = 0;              ///< standard deviation of the point spread function, pixels; 0: unknown (0.6)
  double min_diameter = 1.5;    ///< pixels; smaller rocks are discarded
  double max_diameter = 100;    ///< pixels
  double min_confidence = 0.5;  ///< candidates below are discarded; 0 keeps all
};

/// Rocks of an image, and what is known about their light.
struct RocksFound {
  std::vector<Detection> rocks;
  std::optional<Radians> light;  ///< direction that was used; unset: unknown, so no rocks were sought
  LightCoherence coherence;      ///< how many are lit from there; empty for the method `classic`
  ShadedGround shaded = {};      ///< what of the image lies in shadow; empty for the method `classic`
};

/// Returns the rocks of an image by descending confidence (ties by row, then column).
/// - The outline is an ellipse where the rock meets the ground; `shadow_reach` is the length of level
///   ground that its full height shades.
/// - NaN pixels are no data. Rocks whose shadow touches them or the border are found, with larger standard
///   deviations.
/// - An image without contrast, or without a direction of light, has no rocks.
/// - Where the supposed rocks are not lit from one direction, their confidences are lowered: leaves, roofs.
/// Throws Error{usage} for values out of range and for a sun at or below the horizon. Deterministic; about
/// 15 Mpx/s on one core.
RocksFound search_rocks(const Pixels& image, const RockSearch& search);

/// Returns the rocks of search_rocks.
std::vector<Detection> find_rocks(const Pixels& image, const RockSearch& search);

}  // namespace waymark::pipeline

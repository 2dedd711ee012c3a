// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>

#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/rocks/image_lean.hpp"
namespace waymark {

enum class RockMethod {
  shadow,   ///< shadow fraction against the local ground, measured through a rendered table (docs/rocks.md)
  classic,  ///< maximum entropy threshold and ellipse, as Golombek et al. 2008 and ROSCO
};

/// What to look for in one image.
struct RockSearch {
  RockMethod method = RockMethod::shadow;
  TypeId type = 0;  ///< id of the landmark type `rock`, copied into the detections
  /// Towards the sun in the image, from x (right) towards y (down). Unknown: the direction under which most
  /// rocks are found, sharpened by estimate_sun_angle.
  std::optional<Radians> sun_angle = {};
  /// Above the ground. Unknown: 40 degrees are assumed; outlines and `shadow_reach` depend on it weakly, and
  /// their standard deviations allow for that. Heights need the true one.
  std::optional<Radians> sun_elevation = {};
  /// How rocks lean where the camera looks aslant. Unknown: seen from straight above.
  std::optional<ImageLean> lean = {};
  double blur = 0;              ///< standard deviation of the point spread, pixels; 0: unknown (0.6)
  double min_diameter = 1.5;    ///< pixels; smaller rocks are left out
  double max_diameter = 100;    ///< pixels
  double min_confidence = 0.5;  ///< weaker candidates are left out; 0 keeps all
};

/// Rocks of an image, the most certain first (ties by row, then column). The outline is an ellipse where the
/// rock meets the ground; `shadow_reach` is the length its full height would shade on level ground.
/// NaN pixels are no data; rocks whose shadow touches them or the border are found, with larger deviations.
/// An image without contrast has no rocks, nor has one whose light has no direction (estimate_sun_angle, and
/// no two rocks under any direction). Throws Error{usage} for numbers out of range and a sun not above the
/// ground. Deterministic; about 15 Mpx/s on one core.
std::vector<Detection> find_rocks(const Pixels& image, const RockSearch& search);

}  // namespace waymark

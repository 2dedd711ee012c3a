// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

enum class CraterMethod {
  bowl,   ///< correlation with shaded bowls, rim refinement, verification by a trained model
  edges,  ///< lit and shaded rim edges paired along the light (Cheng, Johnson, Matthies, Olson 2003)
};

/// What to look for in one image.
struct CraterSearch {
  CraterMethod method = CraterMethod::bowl;
  TypeId type = 0;  ///< id of the landmark type `crater`, copied into the detections
  /// Towards the sun in the image, from x (right) towards y (down). Unknown: estimated from the craters.
  std::optional<Radians> sun_angle = {};
  double min_diameter = 8;      ///< pixels, >= 6
  double max_diameter = 0;      ///< pixels; 0: 0.6 of the image's shorter side
  double min_confidence = 0.5;  ///< weaker candidates are left out; 0 keeps all
  bool verify = true;           ///< false: the candidates' correlation alone decides (no trained model)
};

/// Craters of an image, the most certain first (ties by position), no two of them the same rim. The outline
/// is the ellipse of the rim crest. NaN pixels are no data: craters that more than a third of which they hide
/// are not found. An image smaller than 16 px, or without contrast, has none. Throws Error{usage} for
/// diameters out of order or a sun angle that is not finite. Deterministic; about 2 Mpx/s on one core.
std::vector<Detection> find_craters(const Pixels& image, const CraterSearch& search);

/// Direction towards the sun, found by how well craters (not domes) correlate under each direction.
struct CraterSunAngle {
  Radians angle;  ///< in the image, from x towards y, (-pi, pi]
  Radians sd;     ///< spread of the strongest craters' own directions
  int craters;    ///< that agreed
};

/// Nothing where fewer than three clear bowls are seen. Relief read from one image is ambiguous by half a
/// turn (domes under the opposite sun look the same): that the ground has more craters than domes is assumed.
std::optional<CraterSunAngle> estimate_crater_sun_angle(const Pixels& image);

}  // namespace waymark

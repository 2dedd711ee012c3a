// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/units.hpp"
#include "pipeline/rocks/relief_displacement.hpp"
#include "workflows/training/rock_scene.hpp"
namespace waymark::workflows {

/// View of synthetic terrain with its rocks in pixels.
struct SyntheticView {
  RockImage image;
  double sun_angle = 0;  ///< towards the sun in the image, radians from x towards y
  Radians elevation{0};  ///< of the sun
  std::optional<pipeline::ReliefDisplacement> displacement = {};  ///< unset: vertical view
};

/// Renders terrain with craters, dunes, slopes up to about 12 degrees and rocks by Golombek's law. It has 0.3
/// m per pixel and a sun incidence of 30 to 75 degrees; all parameters are random. Numbers below 1000 are for
/// fitting, those from 1000 on for testing.
SyntheticView synthetic_view(int number);

/// Renders the same through a camera of 8 to 50 degrees that looks up to 22 degrees off the vertical. Pixels
/// are finer (0.05 to 0.4 m), half of the ground has no rocks smaller than 1.5 to 6 px, and sun elevations
/// begin at 14 degrees.
SyntheticView leaning_view(int number);

}  // namespace waymark::workflows

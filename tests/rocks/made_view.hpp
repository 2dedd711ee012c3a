// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/units.hpp"
#include "pipeline/rocks/image_lean.hpp"
#include "tests/rocks/rock_scene.hpp"
namespace waymark::testing {

/// A view of ground made by the testbed, with its rocks in pixels.
struct MadeView {
  RockImage image;
  double sun_angle = 0;                ///< towards the sun in the image, radians from x towards y
  Radians elevation{0};                ///< of the sun
  std::optional<ImageLean> lean = {};  ///< nothing: seen from straight above
};

/// Ground with craters, dunes, slopes up to about 12 degrees and rocks by Golombek's law, 0.3 m per pixel,
/// under a sun of incidence 30 to 75 degrees: everything drawn at random. Numbers below 1000 fit the
/// detector, those from 1000 on test it.
MadeView made_view(int number);

/// The same through a camera of 8 to 50 degrees that looks up to 22 degrees off the vertical, on ground of
/// finer pixels (0.05 to 0.4 m), half of it without rocks smaller than 1.5 to 6 px, and sun elevations from
/// 14 degrees: large rocks, low light and rocks that lean.
MadeView leaning_view(int number);

}  // namespace waymark::testing

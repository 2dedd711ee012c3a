// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
#include "tests/rocks/rock_scene.hpp"
namespace waymark::testing {

/// A view from straight above of ground made by the testbed, with its rocks in pixels.
struct MadeView {
  RockImage image;
  double sun_angle = 0;  ///< towards the sun in the image, radians from x towards y
  Radians elevation{0};  ///< of the sun
};

/// Ground with craters, dunes, slopes up to about 12 degrees and rocks by Golombek's law, 0.3 m per pixel,
/// under a sun of incidence 30 to 75 degrees: everything drawn at random. Numbers below 1000 fit the
/// detector, those from 1000 on test it.
MadeView made_view(int number);

}  // namespace waymark::testing

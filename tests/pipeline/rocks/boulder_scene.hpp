// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "core/detection.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::test {

/// Vertical view from a drone: few boulders of 42 to 110 px between craters of 30 to 250 px, in a picture of
/// 640 x 640 pixels of 15 to 60 mm. All else is random: slopes, dunes, sun 18 to 62 degrees high, haze, blur.
struct BoulderScene {
  workflows::SyntheticView view;      ///< boulders that are wholly in the picture
  std::vector<PixelEllipse> craters;  ///< the same
};
BoulderScene boulder_scene(int number);

/// Vertical view of 640 x 640 pixels of ground with hundreds to thousands of rocks of 2 to 40 px by
/// Golombek's law and without craters. All else is random as in boulder_scene().
workflows::SyntheticView rock_field(int number);

}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
namespace waymark {

/// A window of a colour image as shares of full white, [0, 1]; NaN in all bands where nothing is known.
struct ColourWindow {
  Window cells;                    ///< of the whole image
  double cell = 0.6;               ///< side of a pixel, metres
  std::vector<Grid<float>> bands;  ///< red, green, blue, and near infrared where the image has it
};

/// What tells crowns from lawns, roofs and shadows, pixel by pixel: vegetation index, brightness and infrared
/// against the surroundings (Gaussian, 12 m), colours and how rough the light is, each smoothed by 0.6, 1.2,
/// 2.4 and 4.8 m, so that a network can take differences of scales. Brightness is relative, so exposure
/// cancels. One plane per evidence, NaN where the pixel is not known. A pixel's evidence depends on
/// crown_evidence_reach() pixels around and is bitwise the same whatever the window is. O(pixels).
std::vector<Grid<float>> crown_evidence(const ColourWindow& image);

std::int64_t crown_evidence_reach(double cell);

}  // namespace waymark

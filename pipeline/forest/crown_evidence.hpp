// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
namespace waymark::pipeline {

/// Window of a colour image as fractions of full white, [0, 1]; NaN in all bands where there is no data.
struct ColourWindow {
  Window cells;                    ///< in the whole image
  double cell = 0.6;               ///< side of a pixel, metres
  std::vector<Grid<float>> bands;  ///< red, green, blue, and near infrared where the image has it
};

/// Computes per-pixel features that separate crowns from lawns, roofs and shadows. One plane per feature,
/// NaN where the pixel is unknown. O(pixels).
/// - Vegetation index, brightness and infrared relative to the surroundings (Gaussian, 12 m), colours, and
///   roughness.
/// - Each is smoothed by 0.6, 1.2, 2.4 and 4.8 m, so that a network can form differences of scales.
/// - Brightness is relative, so exposure cancels.
/// - Depends on crown_evidence_reach() pixels around; bitwise the same for any window.
std::vector<Grid<float>> crown_evidence(const ColourWindow& image);

std::int64_t crown_evidence_reach(double cell);

}  // namespace waymark::pipeline

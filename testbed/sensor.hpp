// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "testbed/render.hpp"
namespace waymark {

/// Gaussian blur; NaN pixels stay NaN and spread nothing.
Pixels blurred(const Pixels& image, double sd);

/// What the sensor makes of the light: point spread, exposure, noise, full scale. `sunlit` is the brightness
/// of level sunlit ground, which the haze takes as its own.
Pixels exposed(const Pixels& light, const Exposure& exposure, double sunlit, std::uint64_t noise_seed);

}  // namespace waymark

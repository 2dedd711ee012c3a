// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "testbed/render.hpp"
namespace waymark::testbed {

/// Applies a Gaussian blur; NaN pixels stay NaN and have no weight.
Pixels gaussian_blur(const Pixels& image, double sd);

/// Applies the sensor model: point spread function, exposure, noise, full scale. `sunlit` is the brightness
/// of level sunlit ground, which sets the path radiance of the haze.
Pixels apply_sensor(const Pixels& light, const Exposure& exposure, double sunlit, std::uint64_t noise_seed);

}  // namespace waymark::testbed

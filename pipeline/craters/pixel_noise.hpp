// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark {

/// Standard deviation of what changes from pixel to pixel: noise, and texture as fine as noise. Median of the
/// absolute second mixed difference (Immerkaer 1996, made robust); never below 1e-3 of the image's own
/// standard deviation. `pixels` row by row, without NaN.
double pixel_noise(const float* pixels, int columns, int rows);

}  // namespace waymark

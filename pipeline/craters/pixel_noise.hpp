// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::pipeline {

/// Returns the standard deviation of pixel noise and of texture as fine as noise. Median of the absolute
/// second mixed difference (Immerkaer 1996, made robust); at least 1e-3 of the standard deviation of the
/// image. `pixels` row by row, without NaN.
double pixel_noise(const float* pixels, int columns, int rows);

}  // namespace waymark::pipeline

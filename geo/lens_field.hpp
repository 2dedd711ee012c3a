// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>
#include "geo/camera.hpp"
namespace waymark {

/// How far from the axis the radial distortion still grows: beyond it an image radius belongs to two
/// directions. Brown: as tan(theta), fisheye: theta, at most pi/2. Infinity where it always grows.
/// The last lens asked about is remembered per thread.
double field_of(const Camera& camera);

/// The smallest s > 0 where a0 + a1 s + a2 s^2 + ... changes sign, infinity where there is none. Brackets
/// between the roots of the derivative, then bisects to machine precision.
double first_positive_root(const std::vector<double>& coefficients);

}  // namespace waymark

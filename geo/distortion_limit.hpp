// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <vector>
#include "geo/camera.hpp"
namespace waymark::inline geo {

/// Returns the distance from the axis up to which the radial distortion increases and is invertible. Brown:
/// tan(theta); fisheye: theta, at most pi/2. Infinity if the distortion always increases. Each thread caches
/// the result for its last lens.
double distortion_limit(const Camera& camera);

/// Returns the smallest s > 0 at which a0 + a1 s + a2 s^2 + ... changes sign, infinity if there is none.
/// Brackets the root between the roots of the derivative, then bisects to machine precision.
double first_positive_root(const std::vector<double>& coefficients);

}  // namespace waymark::inline geo

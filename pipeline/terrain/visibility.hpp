// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark::pipeline {

/// Returns the expected visibility of a summit: the expected fraction of the terrain within `range` that sees
/// it, [0, 1]. The paper (3.1) derives it from prominence and isolation without a formula.
///
/// Model: the summit stands `prominence` above its surroundings, so the curvature of the body hides it beyond
/// sqrt(2 R prominence). Nearer, a line of sight is unobstructed with probability exp(-distance / L).
/// The free length L = sqrt(kSightLength * sqrt(prominence * isolation)) grows with the summit's height above
/// its surroundings and with their extent. Averaged over the disc of `range`:
///   2 L^2 / range^2 * (1 - (1 + m / L) exp(-m / L)),  m = min(range, sqrt(2 R prominence)).
/// Never decreases with prominence, isolation or the body's radius. An isolation beyond `range` (or infinite)
/// counts as `range`. 0 if prominence or isolation is 0. Agreement with viewsheds:
/// docs/methods/visibility.md.
double expected_visibility(Meters prominence, Meters isolation, Meters body_radius, Meters range);

/// Metres; fitted to ray-cast viewsheds on real tiles, see docs/evaluation/2026-11-21-visibility.md.
inline constexpr double kSightLength = 40000;

}  // namespace waymark::pipeline

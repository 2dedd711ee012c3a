// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark {

/// Expected visibility of a summit from the ground: the share of the ground within `range` of it from which a person
/// is expected to see it, in [0, 1]. The paper (3.1) derives it from prominence and isolation without saying how.
///
/// Model: the summit stands `prominence` above the ground it dominates, so the curve of the body hides it beyond
/// sqrt(2 R prominence); nearer, a line of sight survives other ground with probability exp(-distance / L), where the
/// free length L = kFreeLength * sqrt(prominence * isolation) grows with how far the summit rises over its surroundings
/// and how far these reach. Averaged over the disc of `range`:
///   2 L^2 / range^2 * (1 - (1 + m / L) exp(-m / L)),  m = min(range, sqrt(2 R prominence)).
/// Grows with prominence, with isolation and with the body's radius. An unlimited isolation (the highest summit) may
/// be passed as infinity; it counts as `range`, beyond which nothing is asked. 0 where prominence or isolation is 0.
/// How well it agrees with viewsheds on real ground: docs/visibility.md.
double expected_visibility(Meters prominence, Meters isolation, Meters body_radius, Meters range);

/// Fitted to ray-cast viewsheds; see docs/visibility.md.
inline constexpr double kFreeLength = 2.0;

}  // namespace waymark

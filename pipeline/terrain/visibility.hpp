// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark {

/// Expected visibility of a summit from the ground: the share of the ground within `range` of it from which a
/// person is expected to see it, in [0, 1]. The paper (3.1) derives it from prominence and isolation without
/// saying how.
///
/// Model: the summit stands `prominence` above the ground it dominates, so the curve of the body hides it
/// beyond sqrt(2 R prominence); nearer, a line of sight survives other ground with probability exp(-distance
/// / L). The free length L = sqrt(kSightLength * sqrt(prominence * isolation)) grows with how far the summit
/// rises over its surroundings and how far these reach. Averaged over the disc of `range`:
///   2 L^2 / range^2 * (1 - (1 + m / L) exp(-m / L)),  m = min(range, sqrt(2 R prominence)).
/// Never falls with prominence, isolation or the body's radius. An isolation beyond `range` (or infinite, the
/// highest summit) counts as `range`: nothing farther is asked. 0 where prominence or isolation is 0. How
/// well it agrees with viewsheds on real ground: docs/visibility.md.
double expected_visibility(Meters prominence, Meters isolation, Meters body_radius, Meters range);

/// Metres; fitted to the level of viewsheds ray-cast on real tiles, see docs/visibility.md.
inline constexpr double kSightLength = 40000;

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "core/units.hpp"
#include "geo/dem_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "pipeline/terrain/prominence.hpp"
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

struct MountainTopOptions {
  Meters min_isolation{0};  ///< summits nearer than this to higher terrain are left out
  Meters visible_range{10000};
};

struct MountainTops {
  std::vector<Landmark> landmarks;               ///< in row order of their cells
  std::map<std::string, std::int64_t> rejected;  ///< summits by reason
};

/// Converts the summits of a window to landmarks of type mountain_top. `summits` are all of the grid, in row
/// order of their cells, `isolations` in the same order: parents may lie anywhere.
/// - Position: centre of the cell, map CRS. Variance: uniform error over the cell, square metres east and
///   north.
/// - Confidence: the fraction of prominence that unknown terrain cannot reduce.
/// - A parent that was left out is replaced by its nearest ancestor that was not.
/// - Left out and counted: summits near higher terrain, outside the area of interest, or higher or lower than
///   the type allows.
MountainTops mountain_tops(std::span<const Summit> summits, std::span<const Isolation> isolations,
                           const DemSource& dem, const TypeRegistry& types, const MountainTopOptions& options,
                           const Window& window);

}  // namespace waymark::pipeline

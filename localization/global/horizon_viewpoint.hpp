// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/global/skyline.hpp"
#include "localization/global/terrain_grid.hpp"
namespace waymark::localization {

/// Horizon in one direction: tangent of its elevation, and its distance, m. `far` 0: no terrain.
struct HorizonEdge {
  float rise = -1e9F, far = 0;
  /// Tangent up to which terrain in holes of the DEM may rise.
  float possible = -1e9F;

  bool is_known() const { return far > 0 && !(possible > rise); }
};

/// Returns the horizon in sectors of equal width, the first from azimuth 0 (east) towards y (north). Takes
/// some microseconds per sector.
/// - Each sector holds the highest terrain, sampled in blocks about as wide as the sector (cone tracing in a
///   max pyramid).
/// - `nearest` m: terrain nearer than that is ignored. `eye`: m above the datum.
std::vector<HorizonEdge> horizon_ring(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye,
                                      double nearest, int sectors, const SkylineOptions& options);

/// Returns the horizon in one direction, by a ray in steps of about a cell through bilinear heights. Terrain
/// in a hole may be higher than the filled surface by `kHiddenSlope` times the distance to known terrain.
HorizonEdge horizon_at(const TerrainGrid& ground, const Eigen::Vector2d& at, double eye, double azimuth,
                       const SkylineOptions& options);

inline constexpr int kHorizonSectors = 180;

/// Horizon within half a step of a position.
struct HorizonViewpoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double step = 0;
  double relief = 0;  ///< m: standard deviation of the terrain height within half a step
  std::vector<HorizonEdge> ring;
};

/// Computes the horizons at the positions on known terrain, in their order; the same for any number of
/// threads.
std::vector<HorizonViewpoint> compute_horizons(const TerrainGrid& ground, std::span<const Eigen::Vector2d> at,
                                               double step, const SkylineOptions& options);

/// A pose and its log likelihood ratio, given the tops, against an unknown position.
struct HorizonGuess {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0, score = 0;
};

/// Returns the `max_count` best headings at each position, none adjacent, in the order of `viewpoints`. The
/// same for any number of threads.
/// - A top fits if the horizon of its sector, or of a neighbour, is as high as it was seen.
/// - The tolerance is its noise and what half a step changes: the eye's height by the relief, all
///   directions by parallax, both over the distance of the horizon there.
/// - A top that fits nowhere costs at most `kMissed`.
std::vector<HorizonGuess> best_headings(std::span<const HorizonViewpoint> viewpoints,
                                        std::span<const HorizonTop> tops, std::size_t max_count,
                                        const SkylineOptions& options);

}  // namespace waymark::localization

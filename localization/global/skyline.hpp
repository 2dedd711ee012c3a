// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/terrain_pose.hpp"
namespace waymark::localization {

/// A mountain top of the map.
struct SkylineSummit {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< map frame, m
  double height = 0;                             ///< m above the datum of the ground
  double prominence = 0, isolation = 0;          ///< m; 0: unknown
};

/// A top of the horizon: bearing from the robot's x axis to the left, elevation above the horizontal, rad.
struct HorizonTop {
  double bearing = 0, bearing_sd = 0.003;
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
};

/// Options of localization by the skyline.
struct SkylineOptions {
  double body_radius = 0;  ///< m; 0: a plane
  double refraction = 0;   ///< fraction of the curvature compensated by air: 0.13 on Earth
  double eye = 2;          ///< m above the ground
  double reach = 60000;    ///< m: range in which summits are seen
  double step = 1000;      ///< m between positions of the coarse grid; less for small maps
  double sigmas = 3;
  double height_sd = 15;    ///< m: error of summits and terrain, also of a coarse DEM that cuts tops off
  double position_sd = 60;  ///< m: position error of a summit, about a cell of the DEM
  std::int64_t min_matches = 5;
  double min_fraction = 0.8;   ///< fraction of the tops that must fit
  double max_squares = 2;      ///< mean squared distance of matched tops; chance matches have more
  double false_alarms = 1e-3;  ///< expected number of poses of the map that fit as well by chance
  double lead = 100;  ///< factor by which the best pose must be less probable by chance than the next
  std::int64_t max_tried = 60;
  std::optional<double> heading = {};  ///< rad, from a compass
  double heading_sd = 0.05;

  void describe(OptionVisitor& option);
};

/// A pose that explains the tops of a horizon.
struct SkylineFix {
  PoseEstimate at;
  std::vector<std::optional<std::uint32_t>> summits;  ///< summit of each top, if it is one
  int matched = 0;                                    ///< tops or rays that fit, summits or not
  int compared = 0;                                   ///< tops or rays whose horizon the DEM knows
  double squares = 0, log_false_alarms = 0;
};

/// Result of a search. `reason` says why there is no fix.
struct SkylineAnswer {
  std::optional<SkylineFix> fix;
  std::string_view reason = {};
  std::vector<SkylineFix> candidates;  ///< best first
};

/// Returns the pose of a robot that sees these tops on its horizon (for the idea: Baatz et al. 2012; Saurer
/// et al. 2016; Tzeng et al. 2013). Tops without elevation are not used. Deterministic for any number of
/// threads. 5 s of one core for 110 km x 80 km after 4 s for the index.
/// - The horizon of each position of a grid is computed from the DEM. A position and heading are scored by
///   the tops that lie on that horizon, within what half a step of the grid changes there.
/// - The best positions are refined until they are about two cells of the DEM wide, and the best of these
///   are fitted. Each top is a local maximum of the horizon by rays, or a summit in front of higher
///   terrain.
/// - A fix must be too good for chance, explain four fifths of the tops, and have no rival.
/// - Summits give the search area and the names of tops.
SkylineAnswer find_by_skyline(std::span<const HorizonTop> tops, std::span<const SkylineSummit> summits,
                              const TerrainHeight& ground, const SkylineOptions& options = {});

/// Returns whether the line between two points (m, height above datum) clears the terrain, curvature
/// included. Samples every `step` metres; ignores the last `margin` metres.
bool clears_terrain(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const TerrainHeight& ground,
                    const SkylineOptions& options, double step, double margin);

/// Returns the least-squares pose from matched tops. `std::nullopt` if they do not determine it. `start`
/// must be close.
std::optional<PoseEstimate> resection(std::span<const HorizonTop> tops,
                                      std::span<const SkylineSummit> summits,
                                      std::span<const std::optional<std::uint32_t>> matches,
                                      const PoseEstimate& start, const TerrainHeight& ground,
                                      const SkylineOptions& options);

}  // namespace waymark::localization

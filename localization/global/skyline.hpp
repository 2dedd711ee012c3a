// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/ground.hpp"
namespace waymark {

/// A mountain top of the map.
struct SkylineSummit {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< map frame, m
  double height = 0;                             ///< m above the datum of the ground
  double prominence = 0, isolation = 0;          ///< m; 0: not known
};

/// A top of the horizon: bearing from the robot's x axis to the left, elevation above the horizontal, rad.
struct HorizonTop {
  double bearing = 0, bearing_sd = 0.003;
  std::optional<double> elevation = {};
  double elevation_sd = 0.002;
};

struct SkylineOptions {
  double body_radius = 0;  ///< m; 0: a plane
  double refraction = 0;   ///< part of the curvature the air takes away: 0.13 on Earth
  double eye = 2;          ///< m above the ground
  double reach = 60000;    ///< m: summits further away are not seen
  double step = 1000;      ///< m between the places tried first; less for small maps, more for very large
  double sigmas = 3;
  double height_sd = 15;  ///< m: error of summits and ground, also of a coarse DEM that cuts tops off
  double place_sd = 60;   ///< m: error of a summit's place, about a cell of the DEM
  std::int64_t least_matches = 5;
  double least_share = 0.8;    ///< part of the tops that must fit
  double most_squares = 2;     ///< squared distance per top that fits; matches by chance are farther off
  double false_alarms = 1e-3;  ///< poses of the map that may fit as well by chance
  double lead = 100;           ///< by which the best pose must be less probable by chance than the next
  std::int64_t most_tried = 60;
  std::optional<double> heading = {};  ///< rad, of a compass
  double heading_sd = 0.05;

  void describe(OptionVisitor& option);
};

struct SkylineFix {
  PoseEstimate at;
  std::vector<std::optional<std::uint32_t>> summits;  ///< of each top: which summit it is, if it is one
  int matched = 0;                                    ///< tops that fit, summits or not
  double squares = 0, log_false_alarms = 0;
};

struct SkylineAnswer {
  std::optional<SkylineFix> fix;
  std::string_view reason = {};
  std::vector<SkylineFix> candidates;  ///< best first
};

/// Where a robot stands that sees these tops on its horizon (for the idea: Baatz et al. 2012; Saurer et al.
/// 2016; Tzeng et al. 2013). The whole horizon of each place of a grid is computed from the DEM; a place and
/// heading count by how many tops lie on that horizon, each within what half a step of the grid changes
/// there. The best places are divided and looked at again until they are about two cells of the DEM wide,
/// the best of these fitted: each top is a local maximum of the horizon by rays, or a summit that stands free
/// before higher ground. A fix must be too good for chance, explain four fifths of the tops, and have no
/// rival. Tops without elevation are not used. Summits give the area and the names of tops. Deterministic for
/// any number of threads. 5 s of one core for 110 km x 80 km after 4 s for the index.
SkylineAnswer find_by_skyline(std::span<const HorizonTop> tops, std::span<const SkylineSummit> summits,
                              const GroundHeight& ground, const SkylineOptions& options = {});

/// Whether the line from one point (m, height above datum) to another clears the ground, curvature included.
/// Steps of `step` metres, the last `margin` metres are not looked at.
bool clears_ground(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const GroundHeight& ground,
                   const SkylineOptions& options, double step, double margin);

/// Least squares of a pose by matched tops; nothing where they do not determine it. `start`: near enough.
std::optional<PoseEstimate> resection(std::span<const HorizonTop> tops,
                                      std::span<const SkylineSummit> summits,
                                      std::span<const std::optional<std::uint32_t>> matches,
                                      const PoseEstimate& start, const GroundHeight& ground,
                                      const SkylineOptions& options);

}  // namespace waymark

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
  double step = 500;       ///< m between the places tried first
  double sigmas = 3;
  double height_sd = 15;  ///< m: error of summits and ground, also of a coarse DEM that cuts tops off
  double place_sd = 60;   ///< m: error of a summit's place, about a cell of the DEM
  std::int64_t least_matches = 5;
  double false_alarms =
      1e-5;           ///< poses of the map that may fit as well by chance; summits repeat their looks
  double lead = 100;  ///< by which the best pose must be less probable by chance than the next
  std::int64_t most_tried = 150;
  std::optional<double> heading = {};  ///< rad, of a compass
  double heading_sd = 0.05;

  void describe(OptionVisitor& option);
};

struct SkylineFix {
  PoseEstimate at;
  std::vector<std::optional<std::uint32_t>> summits;  ///< of each top: index of the summit
  int matched = 0;
  double squares = 0, log_false_alarms = 0;
};

struct SkylineAnswer {
  std::optional<SkylineFix> fix;
  std::string_view reason = {};
  std::vector<SkylineFix> candidates;  ///< best first
};

/// Where a robot stands that sees these tops on its horizon (for the idea: Cozman & Krotkov 1996; Baboud et
/// al. 2011). Places of a regular grid vote by bearing differences and elevations; a summit counts by how
/// likely it stands on a horizon: one whose isolation exceeds its distance is higher than all between. The
/// best places are fitted (resection: at least 3 bearings, 2 with a compass), summits hidden by the ground
/// are left out, and a fix must be too good for chance. Tops of ridges that are no summits are expected.
/// About a second for 100 km x 100 km and 500 summits.
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

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "planning/obstacle_memory.hpp"
#include "planning/route_search.hpp"
#include "workflows/planning/read_route.hpp"
#include "workflows/planning/route_cells.hpp"
namespace waymark::workflows {

/// What a vehicle on its route knows when it plans again.
struct DrivePlanRequest {
  localization::PoseEstimate from;                       ///< map frame
  Eigen::Vector2d to = Eigen::Vector2d::Zero();          ///< map frame
  std::vector<planning::SeenObstacle> obstacles;         ///< map frame
  std::span<const localization::LandmarkKey> gone = {};  ///< of the map, ascending
};

struct DrivePlan {
  std::vector<RoutePoint> points;
  double length = 0, worst_sd = 0;  ///< metres
  bool keeps_limit = true;
};

/// Plans the rest of a route while it is driven.
class DrivePlanner {
 public:
  struct Settings {
    SensorCoverage coverage;
    double cell = 2;         ///< metres
    double limit_sigma = 0;  ///< metres; 0: none
    double clearance = 1.5;  ///< metres between the vehicle's middle and an obstacle
    localization::OdometryNoise noise = {};
    localization::LineOfSight visible = {};  ///< empty: terrain hides no landmark; must be thread-safe
  };
  /// `hazards` may be null.
  DrivePlanner(localization::LandmarkGrid landmarks, Settings settings,
               std::shared_ptr<const HazardClasses> hazards);

  /// Returns the shortest route that keeps the limit; if none does, a compromise of length and sd that counts
  /// a metre at the limit twice. `std::nullopt` if hazards and obstacles leave none.
  std::optional<DrivePlan> plan(const DrivePlanRequest& request) const;

  /// Returns the largest sd that is expected on a path from a pose, metres.
  double expected_sd(const localization::PoseEstimate& from, std::span<const Eigen::Vector2d> path,
                     std::span<const localization::LandmarkKey> gone) const;

  const localization::LandmarkGrid& landmarks() const { return landmarks_; }
  const planning::LandmarkSensing& sensing() const { return sensing_; }
  const Settings& settings() const { return settings_; }

 private:
  localization::LandmarkGrid landmarks_;
  Settings settings_;
  planning::LandmarkSensing sensing_;
  std::shared_ptr<const HazardClasses> hazards_;
};

}  // namespace waymark::workflows

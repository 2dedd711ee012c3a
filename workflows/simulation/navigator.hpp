// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "planning/landmark_watch.hpp"
#include "planning/obstacle_memory.hpp"
#include "planning/vehicle.hpp"
#include "testbed/drive/drive_settings.hpp"
#include "testbed/drive/vehicle_motion.hpp"
#include "workflows/localization/live_localizer.hpp"
#include "workflows/planning/drive_planner.hpp"
#include "workflows/planning/read_route.hpp"
#include "workflows/simulation/drive_report.hpp"
namespace waymark::workflows {

/// Path of a plan, with the planned sd at each point.
struct PlannedPath {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> sd;
};

/// The vehicle's own part of a drive: what it knows and decides. It never sees the truth.
class Navigator {
 public:
  Navigator(const testbed::NavigationModel& model, const planning::Vehicle& vehicle, double speed,
            double scanner_height, const LiveLocalizer& live, DrivePlanner planner,
            const std::vector<RoutePoint>& stations, DriveReport& report);
  /// Takes the sightings that the localizer took last.
  void look(double t);
  /// Returns what to do until the next step; `std::nullopt` if the drive has ended.
  std::optional<testbed::DriveCommand> decide(double t, double driven);

 private:
  /// Ends the drive, and notes the event.
  std::optional<testbed::DriveCommand> end(const std::string& kind, const std::string& reason);
  void note(const std::string& kind, const std::string& reason);
  void follow(const std::vector<RoutePoint>& stations);

  /// Returns the obstacles in the map frame, by the estimated pose.
  std::vector<planning::SeenObstacle> obstacles(const localization::Pose2& pose) const;

  /// Stops or drives round obstacles on the path. Returns false if the drive has ended.
  bool avoid_obstacles(const localization::PoseEstimate& pose);
  /// Returns the first point of the path beyond the obstacles ahead that is clear of them.
  std::size_t rejoin_at(const std::vector<planning::SeenObstacle>& all) const;
  /// Drives round obstacles and back to the path, or to the goal if that cannot be.
  bool detour(const localization::PoseEstimate& pose, const std::string& reason);
  /// Plans a route to the goal. Returns false if the drive has ended.
  bool replan(const localization::PoseEstimate& pose, const std::string& reason);
  /// Plans again if the sd exceeds the plan, or if landmarks that the plan counts on are gone.
  void check_plan(const localization::PoseEstimate& pose, double driven);

  const testbed::NavigationModel& model_;
  const planning::Vehicle& vehicle_;
  double speed_, scanner_height_;
  const LiveLocalizer& live_;
  DrivePlanner planner_;
  planning::LandmarkWatch watch_;
  planning::ObstacleMemory memory_;
  DriveReport& report_;
  Eigen::Vector2d goal_;
  PlannedPath path_;
  std::optional<testbed::PathPursuit> pursuit_;
  std::vector<localization::LandmarkKey> gone_;
  double t_ = 0, planned_at_ = 0, lost_since_ = 0;
  int looks_ = 0;
  bool was_doubtful_ = false, looked_ = false;
};

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
#include "planning/vehicle.hpp"
#include "testbed/scene.hpp"
namespace waymark::workflows {

/// What happened on the way of a drive that follows a route.
struct DriveEvent {
  double t = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< estimated, map frame
  std::string kind;                              ///< replanned, stopped, ruled_out, ended
  std::string reason;
};

/// A drive along a route, as written to drive.json. Metres and seconds.
struct DriveReport {
  bool reached = false;
  std::string ended;  ///< goal, contact, no_route, gave_up, too_steep, tipped_over, stuck, lost, time
  double seconds = 0, driven = 0;
  double goal_distance = 0;                   ///< true distance to the goal at the end
  double planned_length = 0, planned_sd = 0;  ///< of the first plan; sd: its largest
  double worst_sd = 0;                        ///< largest estimated sd of the position
  double rms_error = 0, worst_error = 0;      ///< of the estimated position
  double worst_rms = 0;                       ///< largest RMS error over 20 s
  double lost = 0, wrong_and_sure = 0;        ///< fractions of the rows
  double limit_sigma = 0;                     ///< 0: none
  std::optional<bool> limit_kept = {};        ///< the estimated sd; absent without a limit
  std::optional<double> inside_95 = {};       ///< fraction of rows whose error is below 2.45 limits
  std::optional<double> keep_out = {};        ///< metres in hazards and unknown terrain; absent without a map
  std::optional<std::string> contact = {};    ///< with what
  int replans = 0, stops = 0;
  std::vector<DriveEvent> events;
};

/// Fills the figures about errors from the rows of the track and the true poses, both in the map frame.
/// - A row that is not lost is wrong and sure if its position errs by over a metre and beyond its 99.9 %
///   ellipse.
void score_drive(DriveReport& report, const localization::Track& track,
                 const std::vector<localization::StampedPose>& truth);

/// Returns the first rock that the vehicle touches at a pose and that is higher than it can pass; -1: none.
std::int64_t touched_rock(const testbed::Scene& scene, const localization::Pose2& pose,
                          const planning::Vehicle& vehicle);

/// Returns the report as JSON.
std::string drive_report_json(const DriveReport& report);

}  // namespace waymark::workflows

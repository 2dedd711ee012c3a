// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>
#include "geo/local_frame.hpp"
#include "localization/absolute_fix.hpp"
#include "localization/body_motion.hpp"
#include "localization/laser_scan.hpp"
#include "localization/motion_model.hpp"
#include "localization/odometry_drift.hpp"
#include "localization/sighting.hpp"
#include "localization/slam/graph.hpp"
namespace waymark::localization {

/// Correlation times, s, of a sensor's errors with one landmark (fall to 1/e); 0: independent errors.
struct ErrorMemory {
  double range = 0, bearing = 0;
};

/// Widens the standard deviations of sightings whose errors repeat. A camera that sees a bar code four
/// times a second errs four times alike, and a filter that assumes independent errors becomes
/// overconfident. With correlation rho from one sighting to the next (Gauss-Markov), a further sighting
/// carries (1 - rho) / (1 + rho) of the information of the first. Acts on the measurements, so it serves
/// all localizers.
///
/// Sightings of one landmark are associated by position alone, predicted by odometry, never by identities.
/// Ranges without bearing are associated by their identities, since they have no position. Other sightings
/// without position stay as they are.
class RepeatedSightings {
 public:
  explicit RepeatedSightings(const ErrorMemory& memory) : memory_(memory) {}

  void predict(const BodyMotion& motion);
  /// Widens the standard deviations of repeated sightings; `t` is the time of the set, s.
  void widen(SightingSet& seen, double t);

 private:
  struct Last {
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    SeenLandmark seen;
    double t = 0;
  };

  ErrorMemory memory_;
  std::vector<Last> last_;
  std::unordered_map<LandmarkKey, double> last_ranges_;  // s, of ranges without bearing
};

/// Speeds of a differential drive, valid until the next reading.
struct TwistReading {
  double speed = 0, sideways = 0, turn = 0;  ///< m/s forward, m/s left, rad/s left
};
/// Encoder and steering of a car, valid until the next reading.
struct CarReading {
  double wheel_speed = 0, steering = 0;  ///< m/s, rad to the left
};
/// Motion of the robot since the previous reading of this kind.
struct StepReading {
  Pose2 step;
};
using LogReading =
    std::variant<TwistReading, CarReading, StepReading, SightingSet, LaserScan, GnssFix, HeadingFix>;

struct LogEvent {
  double t = 0;  ///< s
  LogReading what;
};

struct StampedPose {
  double t = 0;
  Pose2 pose;
};

/// A tree that a harvester's crane gripped, measured from the machine.
struct FelledReading {
  double t = 0;
  double range = 0, bearing = 0;  ///< m, rad
  double range_sd = 0.1, bearing_sd = 0.01;
  double diameter = 0, height = 0;  ///< m, measured by the head; 0: not measured
};

/// Uids of landmarks by the keys that sightings carry.
using LandmarkNames = std::unordered_map<LandmarkKey, std::string>;

/// Measurements of one drive of a robot, in the order of time.
struct RobotLog {
  std::vector<LogEvent> events;
  std::vector<StampedPose> truth;     ///< true poses, as far as known; ascending
  std::vector<FelledReading> felled;  ///< ascending
  std::optional<Pose2> start;
  double start_sd = 0, start_yaw_sd = 0.05;  ///< m, rad: standard deviations of the start; 0: unknown
  Ackermann car;
  /// Whether positions (truth, start, fixes) are in the map's CRS, not yet in metres of the map frame.
  bool in_crs = false;
  std::string crs;      ///< CRS of positions if `in_crs` and given; any text Crs accepts
  std::string fix_crs;  ///< CRS of the positions of fixes, whatever `in_crs` says; empty: as the others
  LandmarkNames names;
  ErrorMemory error_memory;                ///< of its sensors
  std::optional<OdometryNoise> odometry;   ///< odometry noise of this vehicle, if log or reader state it
  OdometryDrift drift;                     ///< persistent odometry errors of this vehicle
  bool shows_stems = false;                ///< its scans show stems, whatever the map has
  std::shared_ptr<const PoseGraph> graph;  ///< if the log is a graph; the events are derived from it
  std::vector<std::string> remarks;        ///< what the reader corrected or omitted, for people
};

/// Sorts the log by time (stable) and drops events and true poses that are not finite. Adds remarks on
/// these, on gaps in the odometry above `max_gap` seconds and on duplicate times.
void clean_log(RobotLog& log, double max_gap = 1);

/// Converts positions from the map's CRS, and those of fixes from `fix_crs`, to the map's frame. Does nothing
/// if they are in the frame already. Fixes that have no position in the map are omitted, with a remark.
void convert_to_map_frame(RobotLog& log, const LocalFrame& frame);

/// Interpolates the pose at a time linearly between two known poses, yaw the short way round.
/// `std::nullopt` if they are more than `max_gap` seconds apart or do not enclose the time.
std::optional<Pose2> pose_at(std::span<const StampedPose> truth, double t, double max_gap = 0.5);

}  // namespace waymark::localization

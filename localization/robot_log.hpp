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
#include "localization/filters/repeated_sightings.hpp"
#include "localization/laser_scan.hpp"
#include "localization/motion_model.hpp"
#include "localization/sighting.hpp"
#include "localization/slam/graph.hpp"
namespace waymark {

/// Speeds of a differential drive; they hold until the next reading.
struct TwistReading {
  double speed = 0, sideways = 0, turn = 0;  ///< m/s forward, m/s left, rad/s left
};
/// Encoder and steering of a car; they hold until the next reading.
struct CarReading {
  double wheel_speed = 0, steering = 0;  ///< m/s, rad to the left
};
/// How the robot moved since the last such reading.
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

/// A tree that a harvester's crane took hold of, seen from the machine.
struct FelledReading {
  double t = 0;
  double range = 0, bearing = 0;  ///< m, rad
  double range_sd = 0.1, bearing_sd = 0.01;
  double diameter = 0, height = 0;  ///< m, measured by the head; 0: not
};

/// Uids of landmarks that said who they are.
using LandmarkNames = std::unordered_map<LandmarkKey, std::string>;

/// What a robot measured on one drive, in the order of time.
struct RobotLog {
  std::vector<LogEvent> events;
  std::vector<StampedPose> truth;     ///< where it really was, as far as that is known; ascending
  std::vector<FelledReading> felled;  ///< ascending
  std::optional<Pose2> start;
  double start_sd = 0, start_yaw_sd = 0.05;  ///< m, rad: how well it is known; 0: the log does not say
  Ackermann car;
  /// Positions (truth, start, fixes) are in the map's CRS and not yet in metres of the map frame.
  bool in_crs = false;
  std::string crs;  ///< of positions `in_crs`, if the log says; any text Crs understands
  LandmarkNames names;
  ErrorMemory error_memory;                ///< of its sensors
  std::optional<OdometryNoise> odometry;   ///< what the reader knows of this vehicle's odometry
  std::shared_ptr<const PoseGraph> graph;  ///< where the log is a graph; the events are drawn from it
  std::vector<std::string> remarks;        ///< what the reader had to mend or leave out, for people
};

/// Sorts by time (stable), drops events and truth that are not finite, and remarks on that, on gaps in the
/// odometry above `longest_gap` seconds and on times that occur twice.
void tidy(RobotLog& log, double longest_gap = 1);

/// Positions from the map's CRS into its frame; nothing where they are there already.
void place_in(RobotLog& log, const LocalFrame& frame);

/// Pose at a time between two known ones at most `longest_gap` seconds apart, linear, yaw the short way.
std::optional<Pose2> pose_at(std::span<const StampedPose> truth, double t, double longest_gap = 0.5);

}  // namespace waymark

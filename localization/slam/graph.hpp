// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>
#include "localization/pose2.hpp"
namespace waymark {

/// A pose of the robot in a graph.
struct GraphPose {
  std::int64_t id = 0;  ///< as the file or the log counts
  double t = 0;         ///< s; of a file without times its id
  Pose2 at;
  bool given = false;  ///< whether `at` is a first guess worth having
  bool fixed = false;  ///< not to be moved
};

struct GraphLandmark {
  std::int64_t id = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  bool given = false;
};

/// How the robot moved from one pose to another, seen from the first. Information = root' root.
struct StepEdge {
  std::size_t from = 0, to = 0;
  Pose2 step;
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();  ///< square root of the information, upper triangular
};

/// What a sighting measures, in the frame of the sensor.
enum class SightingKind {
  place,          ///< x forward, y left, m
  range_bearing,  ///< m, rad to the left
  bearing,        ///< rad; the first of the two values is not used
};

/// A landmark seen from a pose.
struct SightingEdge {
  std::size_t pose = 0, landmark = 0;
  SightingKind kind = SightingKind::place;
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d root =
      Eigen::Matrix2d::Identity();  ///< as of StepEdge; of a bearing, the last entry counts
  Pose2 robot_from_sensor;
};

/// What was known of a pose or a landmark before the drive.
struct PosePrior {
  std::size_t pose = 0;
  Pose2 at;
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
};
struct LandmarkPrior {
  std::size_t landmark = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2d root = Eigen::Matrix2d::Identity();
};

/// Poses and landmarks, and what is known of where they lie to each other. Edges refer to poses and landmarks
/// by their index; poses stand in the order of the drive.
struct PoseGraph {
  std::vector<GraphPose> poses;
  std::vector<GraphLandmark> landmarks;
  std::vector<StepEdge> steps;
  std::vector<SightingEdge> sightings;
  std::vector<PosePrior> pose_priors;
  std::vector<LandmarkPrior> landmark_priors;
};

/// Whitened difference between measured and expected, and its derivatives. Unused rows are 0.
struct StepError {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_from, by_to;
};
struct SightingError {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
};
StepError step_error(const StepEdge& edge, const Pose2& from, const Pose2& to);
SightingError sighting_error(const SightingEdge& edge, const Pose2& pose, const Eigen::Vector2d& landmark);
/// Derivative by the pose: the root.
Eigen::Vector3d prior_error(const PosePrior& prior, const Pose2& pose);
Eigen::Vector2d prior_error(const LandmarkPrior& prior, const Eigen::Vector2d& landmark);

/// Sum of all squared errors where poses and landmarks stand now.
double chi2(const PoseGraph& graph);

/// Whether something says where the graph lies: a prior on a pose, on two landmarks, or a fixed pose. The
/// first pose is held otherwise.
bool has_gauge(const PoseGraph& graph);

/// Upper triangular R with R'R = information. Throws std::invalid_argument where it is not positive definite.
Eigen::Matrix3d information_root(const Eigen::Matrix3d& information);
Eigen::Matrix2d information_root(const Eigen::Matrix2d& information);

/// Numbers of measurements and of unknowns.
std::size_t residual_count(const PoseGraph& graph);
std::size_t unknown_count(const PoseGraph& graph);

}  // namespace waymark

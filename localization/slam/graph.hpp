// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "localization/pose2.hpp"
#include "localization/slam/slam_line.hpp"
namespace waymark::localization {

/// A pose of the robot in a graph.
struct GraphPose {
  std::int64_t id = 0;  ///< as in the file or the log
  double t = 0;         ///< s; the id if the file has no times
  Pose2 at;
  bool given = false;  ///< whether `at` is a usable initial guess
  bool fixed = false;  ///< constant in the optimisation
};

/// A landmark in a graph.
struct GraphLandmark {
  std::int64_t id = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  bool given = false;
  std::optional<SlamLine> line = {};  ///< of a line, whose two numbers are `at`
};

/// Deviation of a piece of a line, which each sighting of the piece shares. Expected to be 0.
struct GraphDeviation {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();        ///< m and rad
  Eigen::Matrix2d root = Eigen::Matrix2d::Identity();  ///< as of StepEdge
};

/// Relative motion between two poses, in the frame of the first. Information = root' root.
struct StepEdge {
  std::size_t from = 0, to = 0;
  Pose2 step;
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();  ///< square root of the information, upper triangular
};

/// Measurement of a sighting, in the frame of the sensor.
enum class SightingKind {
  position,       ///< x forward, y left, m
  range_bearing,  ///< m, rad to the left
  bearing,        ///< rad; the first of the two values is not used
  range,          ///< m; the second of the two values is not used
  line,           ///< distance of a line, m, and direction of its normal, rad to the left
};

/// A sighting of a landmark from a pose.
struct SightingEdge {
  std::size_t pose = 0, landmark = 0;
  SightingKind kind = SightingKind::position;
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d root =
      Eigen::Matrix2d::Identity();  ///< as of StepEdge; a bearing or range uses its own entry
  Pose2 robot_from_sensor;
  std::optional<std::size_t> deviation = {};  ///< of the piece of a line
  Eigen::Matrix2d by_deviation = Eigen::Matrix2d::Zero();
};

/// Prior knowledge of a pose or a landmark.
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

/// Poses, landmarks, and measurements between them. Edges refer to poses and landmarks by index; poses are
/// in the order of the drive.
struct PoseGraph {
  std::vector<GraphPose> poses;
  std::vector<GraphLandmark> landmarks;
  std::vector<StepEdge> steps;
  std::vector<SightingEdge> sightings;
  std::vector<PosePrior> pose_priors;
  std::vector<LandmarkPrior> landmark_priors;
  std::vector<GraphDeviation> deviations = {};
};

/// Whitened difference between measured and expected, and its Jacobians. Unused rows are 0.
struct StepError {
  Eigen::Vector3d value;
  Eigen::Matrix3d by_from, by_to;
};
struct SightingError {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
  Eigen::Matrix2d by_deviation = Eigen::Matrix2d::Zero();
};
StepError step_error(const StepEdge& edge, const Pose2& from, const Pose2& to);
/// `line`: of a sighting of one; `landmark` then holds its two numbers.
SightingError sighting_error(const SightingEdge& edge, const Pose2& pose, const Eigen::Vector2d& landmark,
                             const SlamLine* line = nullptr,
                             const Eigen::Vector2d& deviation = Eigen::Vector2d::Zero());
/// Returns the error at the present pose, landmark and deviation of the graph.
SightingError sighting_error(const PoseGraph& graph, const SightingEdge& edge);
/// Returns the whitened error of a prior; its Jacobian with respect to the pose is the root.
Eigen::Vector3d prior_error(const PosePrior& prior, const Pose2& pose);
Eigen::Vector2d prior_error(const LandmarkPrior& prior, const Eigen::Vector2d& landmark);
Eigen::Vector2d prior_error(const GraphDeviation& prior, const Eigen::Vector2d& deviation);

/// Returns the sum of all squared errors at the present poses and landmarks.
double chi2(const PoseGraph& graph);

/// Returns whether the graph is anchored: by a prior on a pose, priors on two landmarks, or a fixed pose.
/// Otherwise the first pose is held constant.
bool has_gauge(const PoseGraph& graph);

/// Returns upper triangular R with R'R = information. Throws std::invalid_argument if it is not positive
/// definite.
Eigen::Matrix3d information_root(const Eigen::Matrix3d& information);
Eigen::Matrix2d information_root(const Eigen::Matrix2d& information);

/// Returns the number of measured numbers, and of unknowns.
std::size_t residual_count(const PoseGraph& graph);
std::size_t unknown_count(const PoseGraph& graph);

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "apps/localize_method.hpp"
#include "apps/slam_update.hpp"
#include "localization/slam/existence.hpp"
#include "localization/slam/graph_of_drive.hpp"
#include "localization/slam/graph_solver.hpp"

namespace waymark {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A row for each pose.
Track track_of(const GraphSolution& solution) {
  Track track;
  for (std::size_t i = 0; i < solution.graph.poses.size(); ++i) {
    const GraphPose& pose = solution.graph.poses[i];
    TrackRow row{.t = pose.t, .at = {pose.at, Eigen::Matrix3d::Zero()}};
    if (!solution.pose_covariances.empty()) row.at.covariance = solution.pose_covariances[i];
    track.rows.push_back(row);
  }
  for (const SightingEdge& e : solution.graph.sightings) ++track.rows[e.pose].matched;
  return track;
}

class Graph final : public LocalizeMethod {
 public:
  std::string_view name() const override { return "graph"; }
  std::string_view summary() const override {
    return "least squares over all poses and landmarks at once, of a graph file or of a drive; the map may "
           "be none";
  }
  StartNeed start() const override { return StartNeed::found; }
  bool needs_map() const override { return false; }
  bool makes_map() const override { return true; }
  void describe(OptionVisitor& option) override {
    options_.describe(option);
    slam_.describe(option);
    search_.describe(option);
  }

  Track run(LocalizeTask& task) override {
    if (!task.log.graph) return smoothed(task);
    PoseGraph graph = *task.log.graph;
    if (task.start && !graph.poses.front().given) graph.poses.front().at = task.start->pose;
    const GraphSolution solution = solved(std::move(graph), options_);
    std::vector<SlamLandmark> landmarks(solution.graph.landmarks.size());
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      landmarks[i].log_odds = kSurestLogOdds;
      landmarks[i].key = landmark_key(std::to_string(solution.graph.landmarks[i].id));
      take_over(solution, i, landmarks[i]);
    }
    for (const SightingEdge& e : solution.graph.sightings) ++landmarks[e.landmark].matches;
    write_back(task, landmarks, 0, R"({"method":"graph"})");
    return track_of(solution);
  }

 private:
  static void take_over(const GraphSolution& solution, std::size_t i, SlamLandmark& into) {
    into.at = solution.graph.landmarks[i].at;
    if (!solution.landmark_covariances.empty()) into.covariance = solution.landmark_covariances[i];
  }

  static GraphSolution solved(PoseGraph graph, const GraphOptions& options) {
    const double before = seconds_now();
    GraphSolution solution = optimise(std::move(graph), options);
    std::cout << fmt::format("{:20} {:.4f}\n{:20} {}\n{:20} {}\n{:20} {}\n{:20} {:.3f}\n", "chi2",
                             solution.chi2, "residuals", solution.residuals, "unknowns", solution.unknowns,
                             "converged", solution.converged, "seconds", seconds_now() - before);
    return solution;
  }

  /// Drives with SLAM, then solves for the whole drive.
  Track smoothed(LocalizeTask& task) const {
    const SlamRun run = slam_run(task, slam_);
    EkfSlam slam(run.start, task.map.window.around(run.start.pose.at(), kAround),
                 FeatureScales(task.map.map.types()), run.options, sight_of(task));
    if (task.map.map.landmarks > 0) slam.search_with(finder_for(task, search_));
    GraphOfDrive drive(run.start, slam);
    Track track = play_with(task, run, drive);
    std::vector<SlamLandmark> landmarks;
    PoseGraph graph = drive.graph(landmarks);
    GraphOptions options = options_;
    if (options.kernel == "auto") options.kernel = "huber";
    const GraphSolution solution = solved(std::move(graph), options);
    for (std::size_t i = 0; i < landmarks.size(); ++i) take_over(solution, i, landmarks[i]);
    write_back(task, landmarks, run.options.confirmed, R"({"method":"graph"})");
    // Rows between two poses of the graph keep their place relative to the pose before.
    std::size_t pose = 0;
    Pose2 before = run.start.pose;
    for (std::size_t i = 0; i < track.rows.size(); ++i) {
      const LogReading& what = task.log.events[i].what;
      if (std::holds_alternative<SightingSet>(what) || std::holds_alternative<LaserScan>(what))
        ++pose, before = track.rows[i].at.pose;
      PoseEstimate at{solution.graph.poses[pose].at, Eigen::Matrix3d::Zero()};
      if (!solution.pose_covariances.empty()) at.covariance = solution.pose_covariances[pose];
      track.rows[i].at = moved(at, {inverse(before) * track.rows[i].at.pose, Eigen::Matrix3d::Zero()});
    }
    return track;
  }

  GraphOptions options_;
  SlamOptions slam_;
  SearchOptions search_;
};

}  // namespace

void register_method_graph(MethodTable& methods);
void register_method_graph(MethodTable& methods) {
  methods.add<Graph>();
}

}  // namespace waymark

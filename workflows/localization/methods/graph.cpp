// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "localization/slam/existence_log_odds.hpp"
#include "localization/slam/graph_solver.hpp"
#include "localization/slam/pose_graph_builder.hpp"
#include "workflows/localization/localizer_factory.hpp"
#include "workflows/localization/slam_update.hpp"

namespace waymark::workflows {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

localization::GraphFit fit_of(const localization::GraphSolution& solution) {
  return {.chi2 = solution.chi2,
          .residuals = static_cast<std::int64_t>(solution.residuals),
          .unknowns = static_cast<std::int64_t>(solution.unknowns),
          .converged = solution.converged};
}

/// Returns a row for each pose.
localization::Track to_track(const localization::GraphSolution& solution) {
  localization::Track track;
  for (std::size_t i = 0; i < solution.graph.poses.size(); ++i) {
    const localization::GraphPose& pose = solution.graph.poses[i];
    localization::TrackRow row{.t = pose.t, .at = {pose.at, Eigen::Matrix3d::Zero()}};
    if (!solution.pose_covariances.empty()) row.at.covariance = solution.pose_covariances[i];
    track.rows.push_back(row);
  }
  for (const localization::SightingEdge& e : solution.graph.sightings) ++track.rows[e.pose].matched;
  track.graph = fit_of(solution);
  return track;
}

class Graph final : public LocalizeMethod {
 public:
  std::string_view name() const override { return "graph"; }
  std::string_view summary() const override {
    return "least squares over all poses and landmarks at once, of a graph file or of a drive; the map may "
           "be none";
  }
  StartPolicy start() const override { return StartPolicy::optional; }
  bool requires_map() const override { return false; }
  bool updates_map() const override { return true; }
  SettingGroups groups() const override { return {.kalman = false, .particles = false, .unseen = false}; }
  void describe(OptionVisitor& option) override {
    options_.describe(option);
    slam_.describe(option);
    search_.describe(option);
  }

  localization::Track run(LocalizeTask& task) override {
    if (!task.log.graph) return smooth(task);
    localization::PoseGraph graph = *task.log.graph;
    if (task.start && !graph.poses.front().given) graph.poses.front().at = task.start->pose;
    const localization::GraphSolution solution = solve(std::move(graph), options_, task.callbacks);
    std::vector<localization::SlamLandmark> landmarks(solution.graph.landmarks.size());
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      landmarks[i].log_odds = localization::kSurestLogOdds;
      landmarks[i].key = localization::landmark_key(std::to_string(solution.graph.landmarks[i].id));
      copy_estimate(solution, i, landmarks[i]);
    }
    for (const localization::SightingEdge& e : solution.graph.sightings) ++landmarks[e.landmark].matches;
    write_updated_map(task, landmarks, 0, name());
    return to_track(solution);
  }

 private:
  static void copy_estimate(const localization::GraphSolution& solution, std::size_t i,
                            localization::SlamLandmark& into) {
    into.at = solution.graph.landmarks[i].at;
    if (!solution.landmark_covariances.empty()) into.covariance = solution.landmark_covariances[i];
  }

  static localization::GraphSolution solve(localization::PoseGraph graph,
                                           const localization::GraphOptions& options,
                                           const Callbacks& callbacks) {
    const double before = seconds_now();
    localization::GraphSolution solution = localization::optimise(std::move(graph), options);
    callbacks.send(MessageKind::result,
                   fmt::format("{:20} {:.4f}\n{:20} {}\n{:20} {}\n{:20} {}\n{:20} {:.3f}\n", "chi2",
                               solution.chi2, "residuals", solution.residuals, "unknowns", solution.unknowns,
                               "converged", solution.converged, "seconds", seconds_now() - before));
    return solution;
  }

  /// Runs SLAM over the log, then solves for the whole drive.
  localization::Track smooth(LocalizeTask& task) const {
    const SlamSetup setup = slam_setup(task, slam_);
    localization::EkfSlam slam(
        setup.start, task.map.window.landmarks_near(setup.start.pose.at(), kSlamRadius),
        localization::FeatureScales(task.map.map.types()), setup.options, line_of_sight(task));
    enable_relocalization(slam, task, search_);
    localization::PoseGraphBuilder drive(setup.start, slam);
    localization::Track track = run_slam(task, setup, drive);
    warn_of_unplaced_ranges(task, slam.unplaced_ranges());
    std::vector<localization::SlamLandmark> landmarks;
    localization::PoseGraph graph = drive.graph(landmarks);
    localization::GraphOptions options = options_;
    if (options.kernel == "auto") options.kernel = "huber";
    const localization::GraphSolution solution = solve(std::move(graph), options, task.callbacks);
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      copy_estimate(solution, i, landmarks[i]);
      if (landmarks[i].line) state_as_position(landmarks[i]);
    }
    write_updated_map(task, landmarks, setup.options.confirmed, name());
    // Rows between two poses of the graph keep their position relative to the previous pose.
    std::size_t pose = 0;
    localization::Pose2 before = setup.start.pose;
    for (std::size_t i = 0; i < track.rows.size(); ++i) {
      const localization::LogReading& what = task.log.events[i].what;
      if (std::holds_alternative<localization::SightingSet>(what) ||
          std::holds_alternative<localization::LaserScan>(what))
        ++pose, before = track.rows[i].at.pose;
      localization::PoseEstimate at{solution.graph.poses[pose].at, Eigen::Matrix3d::Zero()};
      if (!solution.pose_covariances.empty()) at.covariance = solution.pose_covariances[pose];
      track.rows[i].at = localization::predict_pose(
          at, {localization::inverse(before) * track.rows[i].at.pose, Eigen::Matrix3d::Zero()});
    }
    track.graph = fit_of(solution);
    return track;
  }

  localization::GraphOptions options_;
  localization::SlamOptions slam_;
  SearchOptions search_;
};

}  // namespace

void register_method_graph(MethodTable& methods);
void register_method_graph(MethodTable& methods) {
  methods.add<Graph>();
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/pose_graph_builder.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <span>

#include "core/covariance.hpp"
#include "localization/filters/measurement.hpp"

namespace waymark::localization {
namespace {

constexpr double kDisregarded = 1e-4;  // root of the information of a step that is disregarded
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Accepts semidefinite covariances: a robot that cannot slip has no error sideways.
Eigen::Matrix3d root_of_covariance(const Eigen::Matrix3d& covariance) {
  constexpr double kMinVariance = 1e-10;  // 10 micrometres, 10 microradians
  return information_root(
      Eigen::Matrix3d((covariance + kMinVariance * Eigen::Matrix3d::Identity()).inverse().eval()));
}

// Finds the pieces of lines that sightings share, where the guess of poses and lines has them. `extents`: of
// the sightings of lines.
void add_deviations(PoseGraph& graph, std::span<const LineExtent> extents,
                    const std::vector<std::size_t>& place) {
  std::size_t next = 0;
  for (SightingEdge& e : graph.sightings) {
    if (e.kind != SightingKind::line) continue;
    const LineExtent& extent = extents[next++];
    if (e.landmark >= place.size() || place[e.landmark] == kNone || !has_deviations(extent)) continue;
    GraphLandmark& landmark = graph.landmarks[place[e.landmark]];
    std::vector<LinePiece>& pieces = landmark.line->pieces;
    const Pose2 sensor = graph.poses[e.pose].at * e.robot_from_sensor;
    const LinePiece now = sighted_piece(*landmark.line, landmark.at, extent, sensor.at());
    auto piece = find_piece(pieces, now);
    if (piece == pieces.end()) {
      piece = pieces.insert(pieces.end(), now);
      piece->slot = graph.deviations.size();
      graph.deviations.push_back({.root = information_root(Eigen::Matrix2d(
                                      piece_deviation(extent, now, now).covariance.inverse()))});
    }
    e.deviation = piece->slot;
    e.by_deviation = piece_deviation(extent, *piece, now).by_deviation;
  }
}

}  // namespace

PoseGraphBuilder::PoseGraphBuilder(const PoseEstimate& start, EkfSlam& slam) : slam_(slam), start_(start) {
  graph_.poses.push_back({.id = 0, .t = 0, .at = start.pose, .given = true, .fixed = false});
  graph_.pose_priors.push_back({.pose = 0, .at = start.pose, .root = root_of_covariance(start.covariance)});
}

void PoseGraphBuilder::predict(const BodyMotion& motion) {
  slam_.predict(motion);
  pending_ = compose(pending_, motion);
}

std::vector<Match> PoseGraphBuilder::update(const SightingSet& seen) {
  const int restarts = slam_.restarts();
  std::vector<Match> matches = slam_.update(seen);
  const std::size_t pose = graph_.poses.size();
  graph_.poses.push_back({.id = static_cast<std::int64_t>(pose),
                          .t = 0,
                          .at = slam_.estimate().pose,
                          .given = true,
                          .fixed = false});
  const Eigen::Matrix3d covariance =
      positive_part((pending_.covariance + pending_.covariance.transpose()) / 2);
  graph_.steps.push_back(
      {.from = pose - 1, .to = pose, .step = pending_.step, .root = root_of_covariance(covariance)});
  pending_ = {};
  if (slam_.restarts() > restarts) {  // SLAM restarted elsewhere: use the finder's pose, not the step
    graph_.steps.back().root = Eigen::Matrix3d::Identity() * kDisregarded;
    graph_.pose_priors.push_back(
        {.pose = pose, .at = slam_.estimate().pose, .root = root_of_covariance(slam_.estimate().covariance)});
    return matches;
  }
  for (std::size_t k = 0; k < matches.size(); ++k) {
    const SeenLandmark& s = seen.sightings[k];
    if (!slam_.last()[k]) continue;
    SightingEdge e;
    e.pose = pose;
    e.landmark = *slam_.last()[k];
    e.robot_from_sensor = seen.robot_from_sensor;
    if (const SlamLine* const line = s.extent ? slam_.line(e.landmark) : nullptr) {
      e.kind = SightingKind::line;
      e.value = line_measurement(s, *line);
      e.root = information_root(Eigen::Matrix2d(line_noise(s, *line).inverse()));
      extents_.push_back(*s.extent);
      graph_.sightings.push_back(e);
      continue;
    }
    e.kind = s.has_position() ? SightingKind::range_bearing
             : s.range        ? SightingKind::range
                              : SightingKind::bearing;
    e.value << s.range.value_or(0), s.bearing.value_or(0);
    e.root = Eigen::Vector2d(1 / s.range_sd, 1 / s.bearing_sd).asDiagonal();
    graph_.sightings.push_back(e);
  }
  return matches;
}

PoseGraph PoseGraphBuilder::graph(std::vector<SlamLandmark>& landmarks) const {
  PoseGraph graph = graph_;
  landmarks = slam_.landmark_states();
  std::vector<std::size_t> place;
  std::vector<std::size_t> ranges;
  for (const SightingEdge& e : graph_.sightings) {
    ranges.resize(std::max(ranges.size(), e.landmark + 1), 0);
    ++ranges[e.landmark];
  }
  std::erase_if(landmarks, [&](const SlamLandmark& l) {
    return l.gone || l.log_odds < 0 || l.index >= ranges.size() || ranges[l.index] == 0;
  });
  for (const SlamLandmark& l : landmarks) {
    place.resize(std::max(place.size(), l.index + 1), kNone);
    place[l.index] = graph.landmarks.size();
    if (const auto known = slam_.prior(l.index)) {
      const Eigen::Matrix2d covariance = l.line ? line_covariance(*known) : known->covariance;
      graph.landmark_priors.push_back({.landmark = graph.landmarks.size(),
                                       .at = l.line ? Eigen::Vector2d(Eigen::Vector2d::Zero()) : known->at,
                                       .root = information_root(Eigen::Matrix2d(covariance.inverse()))});
    }
    graph.landmarks.push_back(
        {.id = static_cast<std::int64_t>(l.index), .at = l.at, .given = true, .line = l.line});
    if (l.line) graph.landmarks.back().line->pieces.clear();
  }
  add_deviations(graph, extents_, place);
  std::erase_if(graph.sightings, [&](const SightingEdge& e) {
    return e.landmark >= place.size() || place[e.landmark] == kNone;
  });
  for (SightingEdge& e : graph.sightings) e.landmark = place[e.landmark];
  return graph;
}

}  // namespace waymark::localization

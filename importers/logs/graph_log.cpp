// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "importers/logs/graph_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

localization::SeenLandmark sighting_of(const localization::SightingEdge& edge, std::int64_t landmark) {
  localization::SeenLandmark seen;
  seen.identity = localization::landmark_key(std::to_string(landmark));
  Eigen::Vector2d value = edge.value;
  Eigen::Matrix2d covariance = (edge.root.transpose() * edge.root).inverse();
  if (edge.kind == localization::SightingKind::position) {
    value << edge.value.norm(), std::atan2(edge.value.y(), edge.value.x());
    const double range = std::max(value[0], 1e-3);
    Eigen::Matrix2d to_polar;
    to_polar << edge.value.x() / range, edge.value.y() / range, -edge.value.y() / (range * range),
        edge.value.x() / (range * range);
    covariance = to_polar * covariance * to_polar.transpose();
  }
  if (edge.kind != localization::SightingKind::range) {
    seen.bearing = value[1];
    seen.bearing_sd = std::sqrt(covariance(1, 1));
  }
  if (edge.kind != localization::SightingKind::bearing) {
    seen.range = value[0];
    seen.range_sd = std::sqrt(covariance(0, 0));
  }
  return seen;
}

}  // namespace

localization::RobotLog import_graph_log(const std::filesystem::path& file, const std::string& format) {
  ImportedGraph imported = import_graph(file, format);
  const localization::PoseGraph& graph = imported.graph;
  localization::RobotLog log;
  log.remarks = std::move(imported.remarks);
  for (const localization::GraphLandmark& l : graph.landmarks)
    log.names.emplace(localization::landmark_key(std::to_string(l.id)), std::to_string(l.id));
  log.start = graph.poses.front().at;
  std::vector<const localization::StepEdge*> step_to(graph.poses.size(), nullptr);
  for (const localization::StepEdge& e : graph.steps)
    if (e.to == e.from + 1 && !step_to[e.to]) step_to[e.to] = &e;
  std::vector<localization::SightingSet> seen(graph.poses.size());
  for (const localization::SightingEdge& e : graph.sightings)
    seen[e.pose].sightings.push_back(sighting_of(e, graph.landmarks[e.landmark].id));
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    const double t = graph.poses[i].t;
    if (step_to[i])
      log.events.emplace_back().t = t, log.events.back().what = localization::StepReading{step_to[i]->step};
    if (seen[i].sightings.empty()) continue;
    log.events.emplace_back().t = t;
    log.events.back().what.emplace<localization::SightingSet>(std::move(seen[i]));
  }
  if (log.events.empty()) log.events.emplace_back().what = localization::StepReading{};
  log.graph = std::make_shared<const localization::PoseGraph>(std::move(imported.graph));
  return log;
}

}  // namespace waymark::importers

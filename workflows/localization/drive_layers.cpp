// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/drive_layers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "geo/point_at_height.hpp"
#include "geodb/shape_layer.hpp"
#include "localization/harvested_trees.hpp"

namespace waymark::workflows {
namespace {

Eigen::Vector2d in_crs(const LocalFrame& frame, const Eigen::Vector2d& at, double height = 0) {
  return point_of_pose(frame, {at.x(), at.y(), height}).xyz.head<2>();
}

AttributeValue or_null(double value) {
  return value > 0 ? AttributeValue(value) : AttributeValue();
}

std::size_t felled_until(const localization::RobotLog& log, double until) {
  const auto after = std::ranges::upper_bound(log.felled, until, {}, &localization::FelledReading::t);
  return static_cast<std::size_t>(after - log.felled.begin());
}

}  // namespace

void write_drive_layers(const std::filesystem::path& map, const localization::RobotLog& log,
                        const localization::Track& track, const LocalFrame& frame, double until) {
  std::vector<geodb::ShapeLayer> layers;
  geodb::ShapeLayer line{.name = "track",
                         .summary = "Where the machine drove",
                         .kind = geodb::ShapeKind::line,
                         .columns = {{"from_t", "s", AttributeSpec::Kind::real, "Time of its first pose"},
                                     {"to_t", "s", AttributeSpec::Kind::real, "Time of its last pose"},
                                     {"largest_sd", "m", AttributeSpec::Kind::real,
                                      "Largest standard deviation of a pose along it"}},
                         .style = {.colour = "#d95f02", .width = 0.8}};
  // Corners closer than a decimetre say nothing.
  std::vector<Eigen::Vector2d> corners;
  std::optional<Eigen::Vector2d> last;
  double largest = 0;
  for (const localization::TrackRow& row : track.rows) {
    largest = std::max(largest, std::sqrt(std::max(row.at.covariance(0, 0), row.at.covariance(1, 1))));
    if (last && !((row.at.pose.at() - *last).norm() > 0.1)) continue;
    last = row.at.pose.at();
    corners.push_back(in_crs(frame, *last, row.z));
  }
  if (corners.size() > 1) {
    line.rows.push_back({{{corners, {}}}, {track.rows.front().t, track.rows.back().t, largest}});
  }
  layers.push_back(std::move(line));
  if (!log.felled.empty()) {
    geodb::ShapeLayer trees{
        .name = "harvested",
        .summary = "Trees felled by the machine",
        .kind = geodb::ShapeKind::point,
        .columns = {{"t", "s", AttributeSpec::Kind::real, "Time of felling"},
                    {"diameter", "m", AttributeSpec::Kind::real, "Stem diameter at 1.3 m"},
                    {"height", "m", AttributeSpec::Kind::real, "Height"},
                    {"sd", "m", AttributeSpec::Kind::real, "Standard deviation of its place"}},
        .style = {.colour = "#b22222"}};
    const std::span<const localization::FelledReading> felled(log.felled.data(), felled_until(log, until));
    for (const localization::HarvestedTree& tree : localization::harvested_trees(felled, track))
      trees.rows.push_back(
          {{{{in_crs(frame, tree.at)}, {}}},
           {tree.t, or_null(tree.diameter), or_null(tree.height), std::sqrt(tree.covariance.trace() / 2)}});
    layers.push_back(std::move(trees));
  }
  geodb::write_layers(map, layers);
}

LiveLayers::LiveLayers(std::filesystem::path map, const localization::RobotLog& log, const LocalFrame& frame,
                       double every)
    : map_(std::move(map)), log_(&log), frame_(frame), every_(every) {
  if (!log.events.empty()) next_ = log.events.front().t;
}

void LiveLayers::operator()(const localization::Track& so_far) {
  const double now = so_far.rows.back().t;
  const std::size_t felled = felled_until(*log_, now);
  if (now < next_ && felled == felled_) return;
  felled_ = felled;
  next_ = now + every_;
  write_drive_layers(map_, *log_, so_far, frame_, now);
}

}  // namespace waymark::workflows

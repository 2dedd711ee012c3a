// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/frame_by_heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/height_above_ground.hpp"
#include "pipeline/reconstruction/adjustment/level_relief.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMaxScaleSd = 0.05;

/// A scale, and the height in the frame that becomes 0.
struct ScaleByHeights {
  double scale = 0, sd = 0, zero = 0;
  std::size_t readings = 0;
};

bool is_posed_in(const Reconstruction& scene, std::size_t image, std::size_t component) {
  return scene.images[image].world_from_camera && scene.images[image].component == component;
}

// Ratios of the heights above ground that were read to those in the frame.
ScaleByHeights scale_by_clearance(const Reconstruction& level, const Observations& seen,
                                  std::size_t component) {
  std::vector<double> ratios, sds;
  for (const ObservedHeightAboveGround& reading : seen.heights_above_ground) {
    if (!is_posed_in(level, reading.image, component)) continue;
    const auto ground = ground_below(level, reading.image);
    if (!ground) continue;
    const double above = level.images[reading.image].world_from_camera->translation().z() - ground->height;
    if (!(above > 0)) continue;
    ratios.push_back(reading.height / above);
    sds.push_back(std::hypot(reading.sd / reading.height, ground->sd / above));
  }
  ScaleByHeights out{.readings = ratios.size()};
  if (ratios.empty()) return out;
  out.scale = median(ratios);
  std::vector<double> off;
  for (double& ratio : ratios) off.push_back(std::abs(ratio / out.scale - 1));
  // The deviations that are stated, or the scatter where that is larger; a median has pi / 2 of the variance.
  out.sd = std::max(median(sds), 1.4826 * median(off)) * std::sqrt(1.571 / double(ratios.size()));
  return out;
}

// Slope of the heights that were read over those in the frame, by the median over all pairs (Theil & Sen).
ScaleByHeights scale_by_heights(const Reconstruction& level, const Observations& seen,
                                std::size_t component) {
  std::vector<std::pair<double, double>> all;  // in the frame, read
  double sd = 0, mean = 0, spread = 0;
  for (const ObservedHeight& reading : seen.heights)
    if (is_posed_in(level, reading.image, component)) {
      all.emplace_back(level.images[reading.image].world_from_camera->translation().z(), reading.height);
      sd = std::max(sd, reading.sd);
    }
  ScaleByHeights out{.readings = all.size()};
  if (all.size() < 2) return out;
  std::vector<double> slopes, zeros;
  for (const auto& a : all) mean += a.first / double(all.size());
  for (const auto& a : all) spread += std::pow(a.first - mean, 2);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(all[i].first - all[j].first) > 0.2 * std::sqrt(spread / double(all.size())))
        slopes.push_back((all[i].second - all[j].second) / (all[i].first - all[j].first));
  if (slopes.empty() || !(spread > 0)) return out;
  out.scale = median(slopes);
  if (!(out.scale > 0)) return out;
  out.sd = sd / out.scale / std::sqrt(spread);
  for (const auto& a : all) zeros.push_back(a.first - a.second / out.scale);
  out.zero = median(zeros);
  return out;
}

}  // namespace

FrameByHeightsResult frame_by_heights(const Reconstruction& scene, const Observations& seen,
                                      std::size_t component) {
  ReliefToPlace relief;
  std::vector<Eigen::Vector3d> points, centres;
  const AdjustedImage* first = nullptr;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const TiePoint& point : scene.points)
    if (point.position && !point.marks.empty() && is_posed_in(scene, point.marks[0].image, component))
      points.push_back(*point.position);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!is_posed_in(scene, i, component)) continue;
    centres.push_back(scene.images[i].world_from_camera->translation());
    if (!first || scene.images[i].name < first->name) first = &scene.images[i];
  }
  if (!first || points.size() < 6) return {.message = "there are too few tie points"};
  for (const ObservedUp& o : seen.ups)
    if (is_posed_in(scene, o.image, component))
      up += scene.images[o.image].world_from_camera->linear() * o.up_in_camera.normalized();
  relief.points = points, relief.centres = centres;
  if (up.norm() > 0) relief.up = up.normalized();
  FrameByHeights frame{.local_from_frame = level_relief(relief).level_from_frame};
  Reconstruction level = scene;
  transform(level, component, frame.local_from_frame);

  ScaleByHeights scale = scale_by_clearance(level, seen, component);
  const bool above_ground = scale.readings >= 2 && scale.scale > 0;
  if (!above_ground) scale = scale_by_heights(level, seen, component);
  if (scale.readings < 2)
    return {.message = fmt::format("{} heights of the {} posed images are known, and 2 are needed",
                                   scale.readings, centres.size())};
  if (!(scale.scale > 0 && scale.sd <= kMaxScaleSd))
    return {
        .message = fmt::format(
            "the heights of the {} cameras give its scale only within {:.2g} %, for they differ too little",
            scale.readings, 100 * scale.sd)};
  const auto at = static_cast<std::size_t>(first - scene.images.data());
  const Eigen::Isometry3d& pose = *level.images[at].world_from_camera;
  if (above_ground) {
    const auto ground = ground_below(level, at);
    scale.zero = ground ? ground->height : 0;
  }
  const Eigen::Vector3d edge = -pose.linear().col(1);  // upper edge of the image
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::atan2(edge.x(), edge.y()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d origin(pose.translation().x(), pose.translation().y(), scale.zero);
  const Similarity& levelled = frame.local_from_frame;
  frame.local_from_frame = {.scale = scale.scale * levelled.scale,
                            .rotation = turn * levelled.rotation,
                            .shift = scale.scale * (turn * (levelled.shift - origin))};
  frame.readings = scale.readings, frame.scale_sd = scale.sd;
  return {.found = frame};
}

}  // namespace waymark::pipeline

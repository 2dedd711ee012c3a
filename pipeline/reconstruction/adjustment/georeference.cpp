// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/georeference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "pipeline/reconstruction/adjustment/start_frame.hpp"

namespace waymark::pipeline {
namespace {

// Takes the poses of a component, and what follows from them.
void drop_component(Reconstruction& scene, std::size_t component) {
  for (AdjustedImage& image : scene.images)
    if (image.component == component) image.world_from_camera.reset(), image.covariance.reset();
  for (TiePoint& point : scene.points)
    if (!point.marks.empty() && scene.images[point.marks[0].image].component == component)
      point.position.reset(), point.covariance.reset();
}

std::set<std::size_t> components_of(const Reconstruction& scene) {
  std::set<std::size_t> out;
  for (const AdjustedImage& image : scene.images)
    if (image.world_from_camera) out.insert(image.component);
  return out;
}

// Moves every component that finds a start into the map. Returns whether one did.
bool start(Reconstruction& scene, const Observations& seen, std::vector<std::string>& messages) {
  std::vector<std::size_t> lost;
  const auto components = components_of(scene);
  for (const std::size_t component : components) {
    const StartFrame frame = start_frame(scene, seen, component);
    const std::string prefix = components.size() > 1 ? fmt::format("component {}: ", component) : "";
    for (const std::string& message : frame.messages) messages.push_back(prefix + message);
    if (frame.map_from_frame)
      transform(scene, component, *frame.map_from_frame);
    else
      lost.push_back(component);
  }
  if (lost.size() == components.size()) return false;
  for (const std::size_t component : lost) drop_component(scene, component);
  scene.frame = ReconstructionFrame::metric;
  return true;
}

// Adds a message for each observation that the adjustment left out, unless the start has named it.
void name_left_out(const Reconstruction& scene, const Observations& seen, Georeferenced& result) {
  const std::vector<std::string> named = result.messages;
  const auto add = [&](const std::string& what, const std::string& text) {
    if (std::ranges::none_of(named, [&](const std::string& m) { return m.starts_with(what + " is "); }))
      result.messages.push_back(what + text);
  };
  for (const ControlResult& point : result.adjustment.control)
    if (!point.note.empty())
      add((point.check ? "check point " : "control point ") + point.name, ": " + point.note);
  for (const RemovedMark& removed : result.adjustment.removed_control)
    add(fmt::format("mark of control point {} in image {}", seen.control[removed.point].name,
                    scene.images[removed.mark.image].name),
        fmt::format(" at column {:.1f}, row {:.1f} contradicts the others by {:.1f} pixels and was left out",
                    removed.mark.pixel.x(), removed.mark.pixel.y(), removed.residual));
  for (const ObservationResult& one : result.adjustment.others)
    if (!one.used && scene.images[one.image].world_from_camera)
      add(fmt::format("{} of image {}", one.kind, scene.images[one.image].name),
          " contradicts the other observations and was left out");
}

}  // namespace

void transform(Reconstruction& scene, std::size_t component, const Similarity& similarity) {
  Eigen::Matrix<double, 6, 6> of_pose = Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::Matrix3d linear = similarity.scale * similarity.rotation;
  of_pose.bottomRightCorner<3, 3>() = linear;
  for (AdjustedImage& image : scene.images) {
    if (!image.world_from_camera || image.component != component) continue;
    image.world_from_camera->linear() = similarity.rotation * image.world_from_camera->linear();
    image.world_from_camera->translation() = similarity * image.world_from_camera->translation();
    if (image.motion) image.motion->shift = linear * image.motion->shift;
    if (image.covariance) image.covariance = of_pose * *image.covariance * of_pose.transpose();
  }
  for (TiePoint& point : scene.points) {
    if (!point.position || point.marks.empty() || scene.images[point.marks[0].image].component != component)
      continue;
    point.position = similarity * *point.position;
    if (point.covariance) point.covariance = linear * *point.covariance * linear.transpose();
  }
}

Georeferenced georeference(Reconstruction& scene, const Observations& observations,
                           const AdjustmentOptions& options) {
  Georeferenced out;
  if (scene.frame != ReconstructionFrame::metric && !start(scene, observations, out.messages)) {
    // What is known of the lenses still counts; positions of another frame do not.
    out.adjustment = adjust(scene, {.lenses = observations.lenses}, options);
    return out;
  }
  out.adjustment = adjust(scene, observations, options);
  out.metric = out.adjustment.free_datum == 0;
  if (!out.metric) {
    scene.frame = ReconstructionFrame::arbitrary;
    out.messages.push_back(fmt::format(
        "the frame is arbitrary: {} of its 7 freedoms are not determined; add control points or positions",
        out.adjustment.free_datum));
  }
  name_left_out(scene, observations, out);
  return out;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/start_frame.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/median.hpp"
#include "core/solve.hpp"
#include "pipeline/reconstruction/adjustment/robust_similarity.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"

namespace waymark::pipeline {
namespace {

/// Pair with the name of what it is a position of.
struct NamedPair {
  std::string name = {};
  PositionPair pair = {};
};

double largest_sd_of(const Eigen::Vector3d& sd) {
  return sd.maxCoeff();
}

bool in_component(const Reconstruction& scene, std::size_t image, std::size_t component) {
  return scene.images[image].world_from_camera && scene.images[image].component == component;
}

// Largest distance between positions of the map. Those ten times as far from their median as half of them
// are, are blunders.
double extent_of(const std::vector<NamedPair>& pairs) {
  constexpr double kFar = 10;
  if (pairs.empty()) return 0;
  const auto median_over = [&](const auto& value) {
    std::vector<double> values(pairs.size());
    std::ranges::transform(pairs, values.begin(), value);
    return median(std::move(values));
  };
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = median_over([=](const NamedPair& p) { return p.pair.map[axis]; });
  const auto distance = [&](const NamedPair& p) { return (p.pair.map - middle).norm(); };
  const double limit = kFar * median_over(distance);
  double extent = 0;
  for (const NamedPair& a : pairs)
    for (const NamedPair& b : pairs)
      if (distance(a) <= limit && distance(b) <= limit)
        extent = std::max(extent, (a.pair.map - b.pair.map).norm());
  return extent;
}

std::vector<NamedPair> pairs_of(const Reconstruction& scene, const Observations& seen,
                                std::size_t component) {
  std::vector<NamedPair> out;
  for (const ControlPoint& point : seen.control) {
    if (point.check || !std::isfinite(largest_sd_of(point.sd))) continue;
    std::vector<Mark> marks = point.marks;
    std::erase_if(marks, [&](const Mark& m) { return !in_component(scene, m.image, component); });
    if (const auto at = triangulate(scene, marks))
      out.push_back({"control point " + point.name, {at->position, point.position, largest_sd_of(point.sd)}});
  }
  for (const ObservedPosition& seen_at : seen.positions)
    if (in_component(scene, seen_at.image, component) && std::isfinite(largest_sd_of(seen_at.sd)))
      out.push_back({"position of image " + scene.images[seen_at.image].name,
                     {scene.images[seen_at.image].world_from_camera->translation(), seen_at.position,
                      largest_sd_of(seen_at.sd)}});
  // A free frame is bent by some thousandths of its extent, which the adjustment will straighten.
  constexpr double kBend = 0.003;
  const double extent = extent_of(out);
  for (NamedPair& p : out) p.pair.sd = std::max(std::hypot(p.pair.sd, kBend * extent), 1e-9);
  return out;
}

// Upward direction in the frame: that of the image which the others agree with best.
std::optional<Eigen::Vector3d> up_of(const Reconstruction& scene, const Observations& seen,
                                     std::size_t component) {
  std::vector<Eigen::Vector3d> all;
  const auto add = [&](std::size_t image, const Eigen::Vector3d& up_in_camera) {
    if (in_component(scene, image, component))
      all.push_back(scene.images[image].world_from_camera->linear() * up_in_camera.normalized());
  };
  for (const ObservedUp& o : seen.ups) add(o.image, o.up_in_camera);
  for (const ObservedAttitude& o : seen.attitudes)
    add(o.image, o.world_from_camera.conjugate() * Eigen::Vector3d::UnitZ());
  if (all.empty()) return std::nullopt;
  const auto disagreement = [&](const Eigen::Vector3d& up) {
    double sum = 0;
    for (const Eigen::Vector3d& other : all) sum += (up - other).norm();
    return sum;
  };
  return *std::ranges::min_element(all, {}, disagreement);
}

// Median of the distances of the component's points from the surface; `std::nullopt` if most are off it.
std::optional<double> misfit(const Reconstruction& scene, std::size_t component, const Similarity& to_map,
                             const ObservedSurface& surface) {
  std::vector<double> heights;
  double off = 0;
  for (const TiePoint& point : scene.points) {
    if (!point.position || point.marks.empty() || !in_component(scene, point.marks[0].image, component))
      continue;
    const Eigen::Vector3d at = to_map * *point.position;
    if (const auto height = surface.height(at.x(), at.y()))
      heights.push_back(std::abs(at.z() - *height));
    else
      ++off;
  }
  if (heights.empty() || off > static_cast<double>(heights.size())) return std::nullopt;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

// Similarity of positions on one line, turned about it until the points fit the surface best.
std::optional<Similarity> by_surface(const Reconstruction& scene, const Observations& seen,
                                     const std::vector<PositionPair>& pairs, std::size_t component) {
  if (!seen.surface || pairs.size() < 2) return std::nullopt;
  const auto along = [&](const PositionPair& a, const PositionPair& b) { return (b.map - a.map).norm(); };
  const PositionPair *from = &pairs[0], *to = &pairs[1];
  for (const PositionPair& a : pairs)
    for (const PositionPair& b : pairs)
      if (along(a, b) > along(*from, *to)) from = &a, to = &b;
  const Eigen::Vector3d frame = to->frame - from->frame, map = to->map - from->map;
  if (!(frame.norm() > 0) || !(map.norm() > from->sd + to->sd)) return std::nullopt;
  const Eigen::Matrix3d start = rotation_between(frame, map);
  std::optional<Similarity> best;
  double lowest = 0;
  for (int step = 0; step < 360; ++step) {
    Similarity trial{.scale = map.norm() / frame.norm()};
    trial.rotation =
        Eigen::AngleAxisd(step * std::numbers::pi / 180, map.normalized()).toRotationMatrix() * start;
    trial.shift = from->map - trial.scale * (trial.rotation * from->frame);
    const auto fit = misfit(scene, component, trial, *seen.surface);
    if (fit && (!best || *fit < lowest)) best = trial, lowest = *fit;
  }
  return best;
}

std::string without_height(const Observations& seen) {
  const auto flat = [](const auto& o) { return !std::isfinite(o.sd.z()); };
  const auto count = std::ranges::count_if(seen.positions, flat) +
                     std::ranges::count_if(seen.control, [&](const auto& p) { return !p.check && flat(p); });
  return count > 0 ? fmt::format(" (and {} without a height)", count) : "";
}

void name_left_out(const std::vector<NamedPair>& pairs, const RobustSimilarity& found,
                   std::vector<std::string>& messages) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (found.agrees[i]) continue;
    const Eigen::Vector3d at = found.map_from_frame * pairs[i].pair.frame;
    std::string text = fmt::format("{} is {:.3g} m from where the images place it", pairs[i].name,
                                   (at - pairs[i].pair.map).norm());
    for (std::size_t j = 0; j < pairs.size(); ++j)
      if (j != i && !found.agrees[j] && (at - pairs[j].pair.map).norm() < 3 * pairs[j].pair.sd)
        text += fmt::format("; it fits the coordinates of {}: are their names swapped?", pairs[j].name);
    messages.push_back(text);
  }
}

}  // namespace

StartFrame start_frame(const Reconstruction& scene, const Observations& seen, std::size_t component) {
  StartFrame out;
  const std::vector<NamedPair> named = pairs_of(scene, seen, component);
  std::vector<PositionPair> pairs;
  for (const NamedPair& p : named) pairs.push_back(p.pair);
  const auto up = up_of(scene, seen, component);
  auto found = robust_similarity(pairs);
  if (!found && up) found = robust_similarity(pairs, *up);
  if (found) {
    out.map_from_frame = found->map_from_frame;
    name_left_out(named, *found, out.messages);
    return out;
  }
  out.map_from_frame = by_surface(scene, seen, pairs, component);
  if (out.map_from_frame) return out;
  const char* remedy = up ? "two that are not above each other are enough, since the vertical is known"
                          : "add some, or the direction of gravity";
  if (pairs.size() < 3)
    out.messages.push_back(
        fmt::format("the frame is arbitrary: {} control points and positions of cameras are known{}, and 3 "
                    "are needed; {}",
                    pairs.size(), without_height(seen), remedy));
  else
    out.messages.push_back(fmt::format(
        "the frame is arbitrary: the {} control points and positions of cameras lie within {:.3g} m of one "
        "line or contradict each other, so the turn about it is unknown; {}",
        pairs.size(), distance_from_line(pairs), remedy));
  return out;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/poses/pose_growth.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/random.hpp"
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"
#include "pipeline/reconstruction/adjustment/solve_network.hpp"
#include "pipeline/reconstruction/adjustment/triangulate.hpp"
#include "pipeline/reconstruction/poses/resection.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kGrowthCauchy = 2;     // standard deviations
constexpr double kGlobalAfter = 1.25;   // growth in images after which all are adjusted
constexpr std::size_t kNeighbours = 6;  // images adjusted with a new one
constexpr std::size_t kMinSeedPoints = 16;

void solve_scene(Reconstruction& scene, const Observations& observations, const AdjustmentOptions& options,
                 int iterations) {
  BuiltNetwork built = build_network(
      scene, observations, options,
      {std::vector<bool>(observations.control.size()), std::vector<bool>(observations.positions.size()),
       std::vector<bool>(observations.attitudes.size()), std::vector<bool>(observations.ups.size()),
       std::vector<bool>(observations.heights.size()),
       std::vector<bool>(observations.heights_above_ground.size()), std::vector<bool>(scene.images.size())});
  const SolveReport report = solve(
      built.network, {.cauchy = kGrowthCauchy, .max_iterations = iterations, .function_tolerance = 1e-5});
  if (report.usable) write_back(built, scene);
}

}  // namespace

PoseGrowth::PoseGrowth(Reconstruction start, std::vector<LensGuess> guesses, GrowthSettings settings)
    : scene_(std::move(start)), guesses_(std::move(guesses)), settings_(settings) {
  failed_at_.assign(scene_.images.size(), 0);
  index_marks();
}

void PoseGrowth::index_marks() {
  marks_.assign(scene_.images.size(), {});
  for (std::size_t p = 0; p < scene_.points.size(); ++p)
    for (std::size_t m = 0; m < scene_.points[p].marks.size(); ++m)
      marks_[scene_.points[p].marks[m].image].push_back({p, m});
}

std::size_t PoseGrowth::posed() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      scene_.images, [](const AdjustedImage& image) { return image.world_from_camera.has_value(); }));
}

std::size_t PoseGrowth::known_points(std::size_t image) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      marks_[image], [&](const Visible& v) { return scene_.points[v.point].position.has_value(); }));
}

double PoseGrowth::limit_of(std::size_t image) const {
  const Camera& camera = scene_.lenses[scene_.images[image].lens].camera;
  return std::max(settings_.pixels,
                  settings_.of_diagonal * std::hypot(double(camera.columns), double(camera.rows)));
}

std::optional<double> PoseGrowth::residual(const TiePoint& point, const Mark& mark) const {
  const AdjustedImage& image = scene_.images[mark.image];
  const Eigen::Isometry3d pose = pose_of_mark(scene_, mark);
  const Eigen::Vector3d in_camera = pose.linear().transpose() * (*point.position - pose.translation());
  const auto seen = project(scene_.lenses[image.lens].camera, Point<CameraFrame>{in_camera});
  return seen ? std::optional((*seen - mark.pixel).norm()) : std::nullopt;
}

// Triangulates from all marks, else from the two that most marks agree with; marks that disagree are dropped.
bool PoseGrowth::place_point(TiePoint& point) {
  std::vector<Mark> seen;
  for (const Mark& m : point.marks)
    if (scene_.images[m.image].world_from_camera) seen.push_back(m);
  if (seen.size() < 2) return false;
  TiePoint trial;
  const auto disagreeing = [&](const std::vector<Mark>& marks) {
    std::vector<std::size_t> images;
    for (const Mark& m : marks) {
      const auto r = residual(trial, m);
      if (!r || !(*r < limit_of(m.image))) images.push_back(m.image);
    }
    return images;
  };
  const auto all = triangulate(scene_, seen);
  if (all) {
    trial.position = all->position;
    if (disagreeing(seen).empty()) {
      if (all->angle < settings_.min_angle) return false;
      point.position = all->position;
      return true;
    }
  }
  if (seen.size() < 3) return false;
  std::optional<std::vector<std::size_t>> smallest;
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  const std::size_t tried = std::min<std::size_t>(seen.size(), 8);
  for (std::size_t i = 0; i < tried; ++i)
    for (std::size_t j = i + 1; j < tried; ++j) {
      const auto two = triangulate(scene_, std::vector<Mark>{seen[i], seen[j]});
      if (!two || two->angle < settings_.min_angle) continue;
      trial.position = two->position;
      std::vector<std::size_t> against = disagreeing(seen);
      if (seen.size() - against.size() < 3 || (smallest && against.size() >= smallest->size())) continue;
      smallest = std::move(against);
      best = two->position;
    }
  if (!smallest) return false;
  std::erase_if(point.marks,
                [&](const Mark& m) { return std::ranges::find(*smallest, m.image) != smallest->end(); });
  point.position = best;
  return true;
}

void PoseGrowth::triangulate_points() {
  for (TiePoint& point : scene_.points)
    if (!point.position) place_point(point);
  index_marks();
}

void PoseGrowth::drop_outliers() {
  for (TiePoint& point : scene_.points) {
    if (!point.position) continue;
    std::erase_if(point.marks, [&](const Mark& m) {
      if (!scene_.images[m.image].world_from_camera) return false;
      const auto r = residual(point, m);
      return !r || !(*r < limit_of(m.image));
    });
    std::vector<Eigen::Vector3d> rays;
    for (const Mark& m : point.marks)
      if (const auto& pose = scene_.images[m.image].world_from_camera)
        rays.push_back((*point.position - pose->translation()).normalized());
    double widest = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      for (std::size_t j = i + 1; j < rays.size(); ++j)
        widest = std::max(widest, rays[i].cross(rays[j]).norm());
    if (widest < 0.6 * std::sin(settings_.min_angle)) point.position.reset();
  }
  index_marks();
}

std::vector<LensPrior> PoseGrowth::lens_priors(std::span<const LensGuess> guesses) {
  std::vector<LensPrior> priors;
  for (std::size_t lens = 0; lens < guesses.size(); ++lens) {
    const Camera& camera = guesses[lens].camera;
    if (!(guesses[lens].focal_sd > 0)) continue;
    const bool brown = camera.lens == Camera::Lens::brown;
    priors.push_back({lens, "f", camera.fx, guesses[lens].focal_sd * camera.fx});
    priors.push_back({lens, "k1", camera.distortion[0], 0.1});
    priors.push_back({lens, "k2", camera.distortion[1], 0.1});
    priors.push_back({lens, "cx", camera.cx, 0.005 * double(camera.columns)});
    priors.push_back({lens, "cy", camera.cy, 0.005 * double(camera.columns)});
    if (brown) {
      priors.push_back({lens, "p1", camera.distortion[2], 2e-3});
      priors.push_back({lens, "p2", camera.distortion[3], 2e-3});
    }
  }
  return priors;
}

// The focal length is free from 3 images of a lens on, radial distortion from 5 on.
std::vector<std::vector<std::string>> PoseGrowth::free_parameters() const {
  std::vector<std::size_t> counts(scene_.lenses.size(), 0);
  for (const AdjustedImage& image : scene_.images)
    if (image.world_from_camera) ++counts[image.lens];
  std::vector<std::vector<std::string>> free(scene_.lenses.size());
  for (std::size_t lens = 0; lens < free.size(); ++lens) {
    if (!(guesses_[lens].focal_sd > 0)) continue;
    if (counts[lens] >= 3) free[lens].push_back("f");
    if (counts[lens] >= 5) free[lens].push_back("k1");
    if (counts[lens] >= 8) free[lens].push_back("k2");
  }
  return free;
}

void PoseGrowth::adjust_all(int iterations) {
  Observations observations;
  observations.lenses = lens_priors(guesses_);
  AdjustmentOptions options;
  options.free_lens_parameters = free_parameters();
  const auto first = std::ranges::find_if(
      scene_.images, [](const AdjustedImage& i) { return i.world_from_camera.has_value(); });
  options.fixed_images = {static_cast<std::size_t>(first - scene_.images.begin())};
  std::erase_if(observations.lenses, [&](const LensPrior& prior) {
    const auto& free = options.free_lens_parameters[prior.lens];
    return std::ranges::find(free, prior.parameter) == free.end();
  });
  expect_motions(scene_);
  solve_scene(scene_, observations, options, iterations);
}

std::vector<std::size_t> PoseGrowth::neighbours(std::size_t image, std::size_t count) const {
  std::vector<std::size_t> common(scene_.images.size(), 0);
  for (const Visible& v : marks_[image])
    if (scene_.points[v.point].position)
      for (const Mark& m : scene_.points[v.point].marks)
        if (m.image != image && scene_.images[m.image].world_from_camera) ++common[m.image];
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < common.size(); ++i)
    if (common[i] > 0) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return common[a] > common[b]; });
  if (order.size() > count) order.resize(count);
  return order;
}

// Adjusts an image, its neighbours and their points; all other images that see the points are fixed.
void PoseGrowth::adjust_around(std::size_t image) {
  std::vector<std::size_t> moving = neighbours(image, kNeighbours);
  moving.push_back(image);
  const std::set<std::size_t> free(moving.begin(), moving.end());
  Reconstruction local;
  local.lenses = scene_.lenses;
  local.images = scene_.images;
  std::vector<std::size_t> taken;
  std::set<std::size_t> involved;
  std::set<std::size_t> known;
  for (const std::size_t i : moving)
    for (const Visible& v : marks_[i])
      if (scene_.points[v.point].position && known.insert(v.point).second) taken.push_back(v.point);
  std::ranges::sort(taken);
  for (const std::size_t p : taken) {
    local.points.push_back(scene_.points[p]);
    for (const Mark& m : scene_.points[p].marks)
      if (scene_.images[m.image].world_from_camera) involved.insert(m.image);
  }
  AdjustmentOptions options;
  for (std::size_t i = 0; i < local.images.size(); ++i) {
    if (!involved.contains(i))
      local.images[i].world_from_camera.reset();
    else if (!free.contains(i))
      options.fixed_images.push_back(i);
  }
  if (options.fixed_images.empty() && moving.size() > 1) options.fixed_images = {moving[0]};
  options.estimate_motions = false;
  solve_scene(local, {}, options, 12);
  for (const std::size_t i : moving) scene_.images[i].world_from_camera = local.images[i].world_from_camera;
  for (std::size_t k = 0; k < taken.size(); ++k) scene_.points[taken[k]].position = local.points[k].position;
  expect_motions(scene_);
}

bool PoseGrowth::seed(const ImagePair& images, const RelativePose& pose) {
  if (pose.direction.isZero()) return false;
  Eigen::Isometry3d second_from_first = Eigen::Isometry3d::Identity();
  second_from_first.linear() = pose.rotation;
  second_from_first.translation() = pose.direction;
  scene_.images[images.first].world_from_camera = Eigen::Isometry3d::Identity();
  scene_.images[images.second].world_from_camera = second_from_first.inverse();
  triangulate_points();
  if (known_points(images.first) < kMinSeedPoints) return false;
  adjust_all(20);
  drop_outliers();
  triangulate_points();
  return known_points(images.first) >= kMinSeedPoints;
}

// Points known in an image count by the cells that they occupy, in grids of 2, 4 and 8 (COLMAP).
std::optional<std::size_t> PoseGrowth::next() const {
  std::optional<std::size_t> best;
  double highest = 0;
  for (std::size_t i = 0; i < scene_.images.size(); ++i) {
    if (scene_.images[i].world_from_camera) continue;
    const std::size_t known = known_points(i);
    if (known < settings_.min_points || double(known) < 1.15 * double(failed_at_[i])) continue;
    const Camera& camera = scene_.lenses[scene_.images[i].lens].camera;
    double score = double(known) * 1e-3;
    for (const double side : {2.0, 4.0, 8.0}) {
      std::set<std::pair<int, int>> cells;
      for (const Visible& v : marks_[i]) {
        const TiePoint& point = scene_.points[v.point];
        if (!point.position) continue;
        const Eigen::Vector2d& at = point.marks[v.mark].pixel;
        cells.insert({static_cast<int>(at.x() / double(camera.columns) * side),
                      static_cast<int>(at.y() / double(camera.rows) * side)});
      }
      score += side * double(cells.size());
    }
    if (score > highest) {
      highest = score;
      best = i;
    }
  }
  return best;
}

bool PoseGrowth::add(std::size_t image) {
  std::vector<ImagedPoint> points;
  for (const Visible& v : marks_[image])
    if (scene_.points[v.point].position)
      points.push_back({*scene_.points[v.point].position, scene_.points[v.point].marks[v.mark].pixel});
  const Camera& camera = scene_.lenses[scene_.images[image].lens].camera;
  const auto found = resect(
      camera, points,
      {.threshold = 1.5 * limit_of(image), .seed = named_seed(points.size(), scene_.images[image].name)});
  if (!found || found->inliers.size() < settings_.min_points ||
      double(found->inliers.size()) < settings_.min_fraction * double(points.size())) {
    failed_at_[image] = points.size();
    return false;
  }
  scene_.images[image].world_from_camera = found->world_from_camera;
  return true;
}

void PoseGrowth::grow() {
  std::size_t last = posed();
  while (const auto image = next()) {
    if (!add(*image)) continue;
    triangulate_points();
    const std::size_t count = posed();
    if (double(count) >= kGlobalAfter * double(last) || count <= 6) {
      adjust_all(15);
      last = count;
    } else {
      adjust_around(*image);
    }
    drop_outliers();
    triangulate_points();
  }
}

double PoseGrowth::settled_cost(std::span<const TiePoint> tracks) {
  adjust_all(30);
  double cost = 0;
  for (std::size_t p = 0; p < tracks.size(); ++p)
    for (const Mark& mark : tracks[p].marks) {
      if (!scene_.images[mark.image].world_from_camera) continue;
      const double limit = limit_of(mark.image), sd = std::max(mark.sd, 0.1);
      const TiePoint& point = scene_.points[p];
      const auto r = point.position ? residual(point, mark) : std::nullopt;
      const double bounded = r ? std::min(*r, limit) : limit;
      cost += std::log1p(bounded * bounded / (sd * sd));
    }
  return cost;
}

void PoseGrowth::finish(std::vector<TiePoint> tracks) {
  scene_.points = std::move(tracks);
  triangulate_points();
  for (int round = 0; round < 2; ++round) {
    adjust_all(30);
    drop_outliers();
    triangulate_points();
  }
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/start_heights.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

constexpr double kFlattest = 0.17;  // sine of 10 degrees

std::optional<Eigen::Vector3d> ray_at_height(const PosedCamera& view, const Eigen::Vector2d& pixel,
                                             double height) {
  const auto line = ray(view, pixel);
  if (!line || !(line->direction.unit.z() < -kFlattest)) return std::nullopt;
  const double range = (height - line->origin.xyz.z()) / line->direction.unit.z();
  if (!(range > 0)) return std::nullopt;
  return line->origin.xyz + range * line->direction.unit;
}

// Small image of a view for probes.
struct ProbeImage {
  std::shared_ptr<const ImageLevel> image;
  double scale = 1;
};

ProbeImage probe_image(const std::vector<SurfaceView>& views, std::size_t v, ImageLevels& images) {
  constexpr std::int64_t kSide = 256;
  const std::int64_t side = std::max(views[v].view.camera.columns, views[v].view.camera.rows);
  int level = 0;
  while ((side >> level) > kSide) ++level;
  return {images.get(v, level), static_cast<double>(1 << level)};
}

constexpr int kPatch = 7, kPatchSize = kPatch * kPatch;
using Patch = std::array<double, kPatchSize>;

// Samples a level patch about a point; false if it leaves the image or has no texture.
bool sample_patch(const PosedCamera& view, const ProbeImage& probe, const Eigen::Vector3d& point,
                  double spacing, Patch& patch) {
  const Pixels& pixels = probe.image->pixels;
  double sum = 0, squares = 0;
  for (int n = 0; n < kPatchSize; ++n) {
    const Eigen::Vector3d at =
        point + spacing * Eigen::Vector3d(n % kPatch - kPatch / 2, n / kPatch - kPatch / 2, 0);
    const auto pixel = project(view, {at});
    if (!pixel) return false;
    const double x = (pixel->x() + 0.5) / probe.scale - 0.5, y = (pixel->y() + 0.5) / probe.scale - 0.5;
    if (!(x >= 0 && y >= 0 && x < static_cast<double>(pixels.columns() - 1) &&
          y < static_cast<double>(pixels.rows() - 1)))
      return false;
    const auto i = static_cast<std::int64_t>(x), j = static_cast<std::int64_t>(y);
    const double a = x - static_cast<double>(i), b = y - static_cast<double>(j);
    const auto p = [&](std::int64_t c, std::int64_t r) { return static_cast<double>(pixels(c, r)); };
    const double value =
        (1 - b) * ((1 - a) * p(i, j) + a * p(i + 1, j)) + b * ((1 - a) * p(i, j + 1) + a * p(i + 1, j + 1));
    patch[static_cast<std::size_t>(n)] = value;
    sum += value;
    squares += value * value;
  }
  const double variance = squares / kPatchSize - sum / kPatchSize * sum / kPatchSize;
  const double min_sd = 2 * probe.image->noise;
  if (!(variance > min_sd * min_sd)) return false;
  for (double& value : patch) value = (value - sum / kPatchSize) / std::sqrt(variance * kPatchSize);
  return true;
}

struct Probe {
  const std::vector<SurfaceView>& views;
  const std::vector<ProbeImage>& images;
  std::size_t view;
  std::vector<std::size_t> partners;
  double nearest, farthest;  // depths, metres
};

std::optional<Eigen::Vector3d> probe_pixel(const Probe& probe, const Eigen::Vector2d& pixel) {
  constexpr int kDepths = 480;
  constexpr double kGood = 0.75, kLead = 0.08;
  const PosedCamera& view = probe.views[probe.view].view;
  const auto line = ray(view, pixel);
  if (!line || !(line->direction.unit.z() < -kFlattest)) return std::nullopt;
  std::vector<double> scores(kDepths, -1);
  const auto at = [&](int k) {
    const double inverse = std::lerp(1 / probe.nearest, 1 / probe.farthest, double(k) / (kDepths - 1));
    return Eigen::Vector3d(line->origin.xyz + line->direction.unit / inverse);
  };
  for (int k = 0; k < kDepths; ++k) {
    const Eigen::Vector3d point = at(k);
    const double spacing =
        (point - line->origin.xyz).norm() / view.camera.fx * probe.images[probe.view].scale;
    Patch own, other;
    if (!sample_patch(view, probe.images[probe.view], point, spacing, own)) continue;
    double sum = 0;
    int seen = 0;
    for (const std::size_t partner : probe.partners) {
      if (!sample_patch(probe.views[partner].view, probe.images[partner], point, spacing, other)) continue;
      double product = 0;
      for (std::size_t n = 0; n < own.size(); ++n) product += own[n] * other[n];
      sum += product;
      ++seen;
    }
    if (seen > 0) scores[static_cast<std::size_t>(k)] = sum / seen;
  }
  const auto best = std::ranges::max_element(scores) - scores.begin();
  if (best == 0 || best == kDepths - 1 || scores[static_cast<std::size_t>(best)] < kGood) return std::nullopt;
  for (int k = 1; k + 1 < kDepths; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (std::abs(k - best) > 6 && scores[i] >= scores[i - 1] && scores[i] >= scores[i + 1] &&
        scores[i] > scores[static_cast<std::size_t>(best)] - kLead)
      return std::nullopt;
  }
  return at(static_cast<int>(best));
}

// Chance matches lie at any depth: the middle half of their heights spans much of the way to the cameras.
bool scattered(const std::vector<Eigen::Vector3d>& points, const std::vector<SurfaceView>& views) {
  constexpr double kMaxSpread = 0.5;  // of the height of the cameras above the points
  if (points.empty()) return false;
  std::vector<double> heights, cameras;
  for (const Eigen::Vector3d& point : points) heights.push_back(point.z());
  for (const SurfaceView& view : views) cameras.push_back(view.view.centre().xyz.z());
  std::ranges::sort(heights);
  std::ranges::sort(cameras);
  const std::size_t n = heights.size();
  const double altitude = cameras[cameras.size() / 2] - heights[n / 2];
  return !(heights[n - 1 - n / 4] - heights[n / 4] <= kMaxSpread * altitude);
}

}  // namespace

std::optional<HeightRange> height_range(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 10) return std::nullopt;
  std::vector<double> heights;
  for (const Eigen::Vector3d& point : points) heights.push_back(point.z());
  std::ranges::sort(heights);
  const std::size_t cut = heights.size() / 50;
  const double low = heights[cut], high = heights[heights.size() - 1 - cut];
  const double more = 0.25 * (high - low);
  return HeightRange{low - more, high + more};
}

std::vector<Eigen::Vector3d> probe_heights(const std::vector<SurfaceView>& views, ImageLevels& images) {
  constexpr std::size_t kViews = 16, kPartners = 4;
  constexpr int kPixels = 10;
  constexpr double kMinFound = 0.08;  // of the pixels
  std::vector<ProbeImage> small;
  for (std::size_t v = 0; v < views.size(); ++v) small.push_back(probe_image(views, v, images));
  const std::size_t used = std::min(kViews, views.size());
  std::vector<std::vector<Eigen::Vector3d>> found(used);
  tbb::parallel_for(std::size_t{0}, used, [&](std::size_t n) {
    const std::size_t v = n * views.size() / used;
    const auto distance = [&](std::size_t other) {
      return (views[other].view.centre().xyz - views[v].view.centre().xyz).norm();
    };
    std::vector<std::size_t> partners;
    for (std::size_t other = 0; other < views.size(); ++other)
      if (other != v && distance(other) > 0) partners.push_back(other);
    std::ranges::stable_sort(partners, {}, distance);
    partners.resize(std::min(partners.size(), kPartners));
    if (partners.empty()) return;
    const Probe probe{
        views, small, v, partners, distance(partners.front()) / 3, 20 * distance(partners.back())};
    const Camera& camera = views[v].view.camera;
    for (int j = 0; j < kPixels; ++j)
      for (int i = 0; i < kPixels; ++i) {
        const Eigen::Vector2d pixel((i + 0.5) / kPixels * static_cast<double>(camera.columns),
                                    (j + 0.5) / kPixels * static_cast<double>(camera.rows));
        if (const auto point = probe_pixel(probe, pixel)) found[n].push_back(*point);
      }
  });
  std::vector<Eigen::Vector3d> all;
  for (const auto& points : found) all.insert(all.end(), points.begin(), points.end());
  const bool few =
      static_cast<double>(all.size()) < kMinFound * static_cast<double>(used) * kPixels * kPixels;
  return few || scattered(all, views) ? std::vector<Eigen::Vector3d>{} : all;
}

std::optional<SurfaceGrid> overlap_grid(const std::vector<SurfaceView>& views, const HeightRange& range,
                                        double cell) {
  constexpr int kSteps = 24;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double west = kInfinity, east = -kInfinity, south = kInfinity, north = -kInfinity;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Camera& camera = views[v].view.camera;
    for (int j = 0; j <= kSteps; ++j)
      for (int i = 0; i <= kSteps; ++i)
        for (const double height : {range.low, range.high}) {
          const Eigen::Vector2d pixel(double(i) / kSteps * double(camera.columns - 1),
                                      double(j) / kSteps * double(camera.rows - 1));
          const auto point = ray_at_height(views[v].view, pixel, height);
          if (!point) continue;
          const bool shared = std::ranges::any_of(views, [&](const SurfaceView& other) {
            if (&other == &views[v]) return false;
            const auto seen = project(other.view, {*point});
            return seen && in_image(other.view.camera, *seen, -0.5);
          });
          if (!shared) continue;
          west = std::min(west, point->x());
          east = std::max(east, point->x());
          south = std::min(south, point->y());
          north = std::max(north, point->y());
        }
  }
  if (!(west < east && south < north)) return std::nullopt;
  SurfaceGrid grid{
      .west = std::floor(west / cell) * cell, .north = std::ceil(north / cell) * cell, .cell = cell};
  grid.columns = static_cast<std::int64_t>(std::ceil((east - grid.west) / cell));
  grid.rows = static_cast<std::int64_t>(std::ceil((grid.north - south) / cell));
  return grid;
}

double usual_gsd(const std::vector<SurfaceView>& views, double height) {
  std::vector<double> sizes;
  for (const SurfaceView& view : views) {
    const Camera& camera = view.view.camera;
    const auto point =
        ray_at_height(view.view, {double(camera.columns - 1) / 2, double(camera.rows - 1) / 2}, height);
    if (point) sizes.push_back(ground_sample_distance(view.view, *point));
  }
  if (sizes.empty()) return 0;
  std::ranges::sort(sizes);
  return sizes[(sizes.size() * 4) / 5];
}

}  // namespace waymark::pipeline

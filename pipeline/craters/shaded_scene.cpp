// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/shaded_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/scene_picture.hpp"
#include "pipeline/craters/scene_relief.hpp"

namespace waymark::pipeline {
namespace {

// Correlation of the final slope along x with that of an undisturbed bowl, over 1.25 radii.
double clarity(const Grid<float>& heights, const LabelledCrater& c) {
  const double radius = c.diameter / 2;
  const int step = std::max(1, static_cast<int>(radius / 12)), reach = static_cast<int>(radius * 1.25);
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int dy = -reach; dy <= reach; dy += step)
    for (int dx = -reach; dx <= reach; dx += step) {
      const auto x = std::lround(c.x) + dx, y = std::lround(c.y) + dy;
      const double r = std::hypot(dx, dy) / radius;
      if (r > 1.25 || !heights.contains(x - step, y) || !heights.contains(x + step, y)) continue;
      const double slope = (heights(x + step, y) - heights(x - step, y)) / (2.0 * step);
      const double bowl = dx / radius * (r < 1 ? 1 : -0.4 / std::pow(r, 5));
      ++n, a += slope, b += bowl, aa += slope * slope, bb += bowl * bowl, ab += slope * bowl;
    }
  if (n < 9) return 0;
  const double spread = (aa - a * a / n) * (bb - b * b / n);
  return spread > 0 ? (ab - a * b / n) / std::sqrt(spread) : 0;
}

// Contrast of the bowl's slope along x over 1 radius, as brightness: rms of slope / tan(elevation).
double contrast(const Grid<float>& heights, const LabelledCrater& c, double elevation) {
  const double radius = c.diameter / 2;
  const int step = std::max(1, static_cast<int>(radius / 8)), reach = static_cast<int>(radius);
  double n = 0, aa = 0;
  for (int dy = -reach; dy <= reach; dy += step)
    for (int dx = -reach; dx <= reach; dx += step) {
      const auto x = std::lround(c.x) + dx, y = std::lround(c.y) + dy;
      if (std::hypot(dx, dy) > radius || !heights.contains(x - 1, y) || !heights.contains(x + 1, y)) continue;
      const double slope = (heights(x + 1, y) - heights(x - 1, y)) / 2.0;
      ++n, aa += slope * slope;
    }
  return n > 0 ? std::sqrt(aa / n) / std::tan(elevation) : 0;
}

// Root mean square slope along x over three cells.
double typical_slope(const Grid<float>& heights) {
  double sum = 0, n = 0;
  for (std::int64_t y = 0; y < heights.rows(); y += 3)
    for (std::int64_t x = 3; x < heights.columns(); x += 3)
      sum += std::pow((heights(x, y) - heights(x - 3, y)) / 3, 2), ++n;
  return std::max(1e-12, std::sqrt(sum / std::max(1.0, n)));
}

}  // namespace

LabelledScene shaded_scene(std::uint64_t seed, int side) {
  Random random(seed, "crater training scene");
  const double elevation = random.uniform(9, 55) * kRadiansPerDegree;
  // Slopes scale with the elevation of the sun, so that relief is equally visible under a high and a low sun.
  const double strength = std::tan(elevation) * random.log_uniform(0.3, 1.5);
  Grid<float> heights =
      fractal_field(random, side, side / random.uniform(1, 4), 2, random.uniform(0.38, 0.62));
  const double rough = std::tan(elevation) * random.log_uniform(0.02, 0.3) / typical_slope(heights);
  for (float& h : heights.cells()) h = static_cast<float>(h * rough);
  add_distractors(heights, random, strength);
  Grid<float> albedo(side, side, 0.0F);
  LabelledScene scene;
  scene.craters = add_craters(heights, albedo, random);

  const double noise = random.log_uniform(0.003, 0.05);
  const Grid<float> patches = fractal_field(random, side, side / 2.0, 4, random.uniform(0.4, 0.8));
  scene.image = light_relief(heights, elevation, random.bernoulli(0.5) ? random.uniform(0, 0.15) : 0.01);
  const double spotted = random.bernoulli(0.5) ? random.uniform(0.02, 0.2) : 0.02,
               rays = random.uniform(0, 1.5);
  cv::Mat1f image(side, side, scene.image.cells().data());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      image(y, x) *=
          static_cast<float>(std::exp(spotted * patches(x, y) + rays * std::min(1.0F, albedo(x, y))));
  cv::GaussianBlur(image, image, {}, random.uniform(0.4, 1.2));
  const double mean = cv::mean(image)[0];
  for (float& value : image) value += static_cast<float>(random.normal(0, noise * mean));
  for (LabelledCrater& c : scene.craters) {
    const double visible =
        contrast(heights, c, elevation) * c.diameter / 8 / noise;  // relative to noise over its area
    c.clarity = std::clamp(clarity(heights, c), 0.0, 1.0) * std::min(1.0, visible / 2);
  }
  stretch_contrast(scene.image, random);
  turn_quarters(scene, static_cast<int>(random.uniform_index(4)));
  return scene;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/shaded_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/scene_relief.hpp"

namespace waymark::pipeline {
namespace {

cv::Mat1f as_matrix(Grid<float>& grid) {
  return {static_cast<int>(grid.rows()), static_cast<int>(grid.columns()), grid.cells().data()};
}

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

// Lambert shading with cast shadows from a sun towards -x at `elevation`.
cv::Mat1f light(const Grid<float>& heights, double elevation, double sky) {
  const int side = static_cast<int>(heights.columns());
  cv::Mat1f brightness(side, side);
  for (int y = 0; y < side; ++y) {
    double shadow = -1e9;  // height of the shadow edge above this cell
    for (int x = 0; x < side; ++x) {
      const double h = heights(x, y);
      shadow -= std::tan(elevation);
      const auto at = [&](int column, int row) {
        return double(heights(std::clamp(column, 0, side - 1), std::clamp(row, 0, side - 1)));
      };
      const double gx = (at(x + 1, y) - at(x - 1, y)) / 2, gy = (at(x, y + 1) - at(x, y - 1)) / 2;
      const double upright = 1 / std::sqrt(1 + gx * gx + gy * gy);
      const double direct = std::max(0.0, (std::sin(elevation) + gx * std::cos(elevation)) * upright);
      const double lit = std::clamp((h - shadow) / 0.5 + 1, 0.0, 1.0);
      brightness(y, x) = static_cast<float>(lit * direct + sky * upright);
      shadow = std::max(shadow, h);
    }
  }
  return brightness;
}

// Contrast stretch and quantisation of published images.
void stretch_contrast(cv::Mat1f& image, Random& random) {
  std::vector<float> sorted(image.begin(), image.end());
  std::sort(sorted.begin(), sorted.end());
  const double cut = random.bernoulli(0.5) ? random.log_uniform(1e-4, 3e-2) : random.log_uniform(1e-4, 2e-3);
  const auto at = [&](double fraction) {
    return double(sorted[static_cast<std::size_t>(fraction * double(sorted.size() - 1))]);
  };
  const double low = random.bernoulli(0.3) ? std::min(at(0.001), 0.0) : at(cut),
               high = at(1 - cut * random.uniform(0.3, 2));
  const double gamma = random.uniform(0.7, 1.4), scale = std::max(1e-6, high - low);
  const double highest = random.bernoulli(0.85) ? 255 : 4000;
  for (float& value : image)
    value = static_cast<float>(
        std::round(highest * std::pow(std::clamp((value - low) / scale, 0.0, 1.0), gamma)));
}

// Rotates the scene by quarter turns, so that no image axis is special.
void turn_quarters(LabelledScene& scene, cv::Mat1f image, int quarters) {
  const double last = image.cols - 1;
  for (int i = 0; i < quarters; ++i) {
    cv::rotate(image, image, cv::ROTATE_90_CLOCKWISE);  // (x, y) -> (last - y, x)
    for (LabelledCrater& c : scene.craters) c = {last - c.y, c.x, c.diameter, c.clarity};
  }
  scene.sun_angle = {
      std::remainder(std::numbers::pi + quarters * std::numbers::pi / 2, 2 * std::numbers::pi)};
  scene.image = Pixels(image.cols, image.rows);
  image.copyTo(as_matrix(scene.image));
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
  cv::Mat1f image = light(heights, elevation, random.bernoulli(0.5) ? random.uniform(0, 0.15) : 0.01);
  const double spotted = random.bernoulli(0.5) ? random.uniform(0.02, 0.2) : 0.02,
               rays = random.uniform(0, 1.5);
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
  stretch_contrast(image, random);
  turn_quarters(scene, image, static_cast<int>(random.uniform_index(4)));
  return scene;
}

}  // namespace waymark::pipeline

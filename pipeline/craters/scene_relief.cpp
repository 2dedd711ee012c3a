// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/scene_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace waymark::pipeline {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kDiffusionLengths = 26;  // tabulated
constexpr double kPerRadius = 40;      // samples

double fresh_height(double r) {
  constexpr double depth = 0.4, rim = 0.2;  // floor below rim, rim above plain / depth; radii
  if (r < 1) return depth * (r * r - 1 + rim);
  return depth * rim / (r * r * r);
}

cv::Mat1f as_matrix(Grid<float>& grid) {
  return {static_cast<int>(grid.rows()), static_cast<int>(grid.columns()), grid.cells().data()};
}

// Distance of every cell from a wandering line, in cells.
cv::Mat1f distance_to_path(Random& random, int side) {
  cv::Mat1b off_path(side, side, static_cast<unsigned char>(1));
  double x = random.uniform(0, side), y = random.uniform(0, side), heading = random.uniform(0, kTurn);
  const double wander = random.uniform(0.05, 0.5), stride = side / 40.0;
  const int strides = static_cast<int>(random.uniform(8, 60));
  for (int i = 0; i < strides; ++i) {
    const double nx = x + stride * std::cos(heading), ny = y + stride * std::sin(heading);
    cv::line(off_path, {cvRound(x), cvRound(y)}, {cvRound(nx), cvRound(ny)}, 0);
    x = nx, y = ny;
    heading += random.normal(0, wander);
  }
  off_path(side / 2, side / 2) = std::min<unsigned char>(off_path(side / 2, side / 2), 1);
  cv::Mat1f distance;
  cv::distanceTransform(off_path, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

void add_line(Grid<float>& heights, Random& random, double strength) {
  const int side = static_cast<int>(heights.columns());
  const cv::Mat1f distance = distance_to_path(random, side);
  const double width = random.log_uniform(3, 60), sign = random.bernoulli(0.65) ? -1 : 1;
  const double rise = sign * width * strength * random.uniform(0.05, 0.4), sharp = random.uniform(1, 4);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double d = distance(y, x) / width;
      if (d < 3) heights(x, y) += static_cast<float>(rise * std::exp(-std::pow(d, sharp)));
    }
}

// Adds a hill or hollow with an irregular outline and random steepness.
void add_blob(Grid<float>& heights, Random& random, double strength) {
  const auto side = heights.columns();
  const double size = random.log_uniform(4, 110), x0 = random.uniform(0, double(side)),
               y0 = random.uniform(0, double(side));
  const double rise = (random.bernoulli(0.7) ? 1 : -1) * size * strength * random.uniform(0.05, 0.35);
  const double sharp = random.log_uniform(1.5, 10), stretch = random.log_uniform(0.4, 2.5),
               turn = random.uniform(0, kTurn);
  std::array<double, 5> wobble{}, phase{};
  const bool regular = random.bernoulli(0.3);
  for (std::size_t k = 0; k < wobble.size(); ++k) {
    wobble[k] = random.normal(0, (regular ? 0.03 : 0.22) / std::sqrt(double(k + 1)));
    phase[k] = random.uniform(0, kTurn);
  }
  const auto reach = static_cast<std::int64_t>(size * 4);
  for (auto y = std::max<std::int64_t>(0, std::int64_t(y0) - reach);
       y < std::min(side, std::int64_t(y0) + reach); ++y)
    for (auto x = std::max<std::int64_t>(0, std::int64_t(x0) - reach);
         x < std::min(side, std::int64_t(x0) + reach); ++x) {
      const double dx = double(x) - x0, dy = double(y) - y0;
      const double u = (dx * std::cos(turn) + dy * std::sin(turn)) * std::sqrt(stretch);
      const double v = (dy * std::cos(turn) - dx * std::sin(turn)) / std::sqrt(stretch);
      double radius = 1;
      const double angle = std::atan2(v, u);
      for (std::size_t k = 0; k < wobble.size(); ++k)
        radius += wobble[k] * std::cos(double(k + 2) * angle + phase[k]);
      const double r = std::hypot(u, v) / size / std::max(0.3, radius);
      heights(x, y) += static_cast<float>(rise * std::exp(-std::pow(r, sharp)));
    }
}

void add_ripples(Grid<float>& heights, Random& random, double strength) {
  const auto side = heights.columns();
  const double wave = random.log_uniform(5, 30), turn = random.uniform(0, kTurn),
               rise = wave * strength * random.uniform(0.02, 0.12);
  const Grid<float> warp = fractal_field(random, static_cast<int>(side), 8 * wave, wave, 0.5);
  const Grid<float> cover = fractal_field(random, static_cast<int>(side), double(side) / 3, 20, 0.5);
  const double min_cover = random.uniform(0.2, 1.5);
  for (std::int64_t y = 0; y < side; ++y)
    for (std::int64_t x = 0; x < side; ++x) {
      const double here = std::clamp((cover(x, y) - min_cover) * 3, 0.0, 1.0);
      if (here <= 0) continue;
      const double along =
          (double(x) * std::cos(turn) + double(y) * std::sin(turn)) / wave + 0.7 * warp(x, y);
      const double phase = along - std::floor(along);  // rises slowly, falls fast
      heights(x, y) += static_cast<float>(here * rise * (phase < 0.7 ? phase / 0.7 : (1 - phase) / 0.3));
    }
}

// Parameters of one crater.
struct Impact {
  double x, y, radius, diffusion_length, depth, floor, elongation, turn, peak, flatten;
  std::array<double, 4> wobble, phase;
};

Impact draw_impact(Random& random, double x, double y, double radius, double oldest) {
  Impact c{.x = x,
           .y = y,
           .radius = radius,
           .diffusion_length = 0,
           .depth = 1,
           .floor = -9,
           .elongation = 1,
           .turn = 0,
           .peak = 0,
           .flatten = 0.6,
           .wobble = {},
           .phase = {}};
  c.diffusion_length = oldest * std::pow(random.uniform(), 0.8);
  c.depth = random.uniform(0.5, 1.05);
  if (random.bernoulli(0.3))
    c.floor = -0.4 * random.uniform(0.05, 0.6);  // infilled floor, radii below the plain
  if (random.bernoulli(0.25)) c.elongation = random.uniform(1, 1.3);
  c.turn = random.uniform(0, kTurn);
  if (radius > 25 && random.bernoulli(0.1)) c.peak = random.uniform(0.03, 0.12);
  for (std::size_t k = 0; k < c.wobble.size(); ++k) {
    c.wobble[k] = random.normal(0, 0.025 / std::sqrt(double(k + 1)));
    c.phase[k] = random.uniform(0, kTurn);
  }
  return c;
}

void excavate(Grid<float>& heights, Grid<float>& bright, const Impact& c, const DegradedCraters& worn) {
  const auto side = heights.columns();
  const auto reach = static_cast<std::int64_t>(c.radius * DegradedCraters::kReach) + 1;
  const auto x0 = std::max<std::int64_t>(0, std::int64_t(c.x) - reach),
             x1 = std::min(side, std::int64_t(c.x) + reach);
  const auto y0 = std::max<std::int64_t>(0, std::int64_t(c.y) - reach),
             y1 = std::min(side, std::int64_t(c.y) + reach);
  double sum = 0, n = 0;
  for (auto y = y0; y < y1; ++y)
    for (auto x = x0; x < x1; ++x)
      if (std::hypot(double(x) - c.x, double(y) - c.y) < 1.2 * c.radius) sum += heights(x, y), ++n;
  const double plain = n > 0 ? sum / n : 0, freshness = std::max(0.0, 1 - c.diffusion_length / 0.12);
  for (auto y = y0; y < y1; ++y)
    for (auto x = x0; x < x1; ++x) {
      const double dx = double(x) - c.x, dy = double(y) - c.y;
      const double u = (dx * std::cos(c.turn) + dy * std::sin(c.turn)) / std::sqrt(c.elongation);
      const double v = (dy * std::cos(c.turn) - dx * std::sin(c.turn)) * std::sqrt(c.elongation);
      double shape = 1;
      const double angle = std::atan2(v, u);
      for (std::size_t k = 0; k < c.wobble.size(); ++k)
        shape += c.wobble[k] * std::cos(double(k + 2) * angle + c.phase[k]);
      const double r = std::hypot(u, v) / c.radius / shape;
      if (r >= DegradedCraters::kReach) continue;
      double h = worn.height(c.diffusion_length, r);
      if (h < c.floor) h = c.floor + 0.1 * (h - c.floor);
      if (c.peak > 0) h += c.peak * std::exp(-r * r / 0.02);
      const double reset =
          c.flatten * std::clamp((1.2 - r) / 0.6, 0.0, 1.0);  // the impact erases earlier relief
      heights(x, y) += static_cast<float>(c.depth * c.radius * h +
                                          reset * (plain - heights(x, y)) * (1 - c.diffusion_length));
      bright(x, y) +=
          static_cast<float>(freshness * freshness * 0.35 * std::exp(-std::max(0.0, r - 0.6) * 2.5));
    }
}

}  // namespace

DegradedCraters::DegradedCraters() {
  constexpr int half = static_cast<int>(kReach * kPerRadius) + 60, side = 2 * half + 1;
  cv::Mat1f fresh(side, side), worn;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      fresh(y, x) = static_cast<float>(fresh_height(std::hypot(x - half, y - half) / kPerRadius));
  for (int i = 0; i < kDiffusionLengths; ++i) {
    const double diffusion_length = kMaxDiffusionLength * i / (kDiffusionLengths - 1);
    if (i == 0)
      worn = fresh;
    else
      cv::GaussianBlur(fresh, worn, {}, diffusion_length * kPerRadius, 0, cv::BORDER_REPLICATE);
    auto& row = rows_.emplace_back();
    const float rest = worn(half, half + static_cast<int>(kReach * kPerRadius));
    for (int r = 0; r <= static_cast<int>(kReach * kPerRadius); ++r)
      row.push_back(worn(half, half + r) - rest);
    crests_.push_back(double(std::max_element(row.begin(), row.end()) - row.begin()) / kPerRadius);
  }
}

double DegradedCraters::height(double diffusion_length, double radii) const {
  const double w = std::clamp(diffusion_length / kMaxDiffusionLength, 0.0, 1.0) * (kDiffusionLengths - 1),
               r = radii * kPerRadius;
  const auto i = std::min(static_cast<std::size_t>(w), rows_.size() - 2);
  if (!(r < double(rows_[0].size() - 1))) return 0;
  const auto j = static_cast<std::size_t>(r);
  const double a = w - double(i), b = r - double(j);
  return (1 - a) * ((1 - b) * rows_[i][j] + b * rows_[i][j + 1]) +
         a * ((1 - b) * rows_[i + 1][j] + b * rows_[i + 1][j + 1]);
}

double DegradedCraters::crest(double diffusion_length) const {
  const double w = std::clamp(diffusion_length / kMaxDiffusionLength, 0.0, 1.0) * (kDiffusionLengths - 1);
  const auto i = std::min(static_cast<std::size_t>(w), crests_.size() - 2);
  return crests_[i] + (w - double(i)) * (crests_[i + 1] - crests_[i]);
}

Grid<float> fractal_field(Random& random, int side, double longest, double shortest, double persistence) {
  Grid<float> field(side, side);
  cv::Mat1f all = as_matrix(field), octave;
  all = 0;
  double weight = 1;
  for (double wave = longest; wave >= shortest; wave /= 2, weight *= persistence) {
    const int cells = std::max(2, static_cast<int>(std::ceil(side / wave * 2))) + 3;
    cv::Mat1f coarse(cells, cells);
    for (float& value : coarse) value = static_cast<float>(random.normal());
    cv::resize(coarse, octave,
               {static_cast<int>(cells * wave / 2) + 1, static_cast<int>(cells * wave / 2) + 1}, 0, 0,
               cv::INTER_CUBIC);
    const int shift_x =
        static_cast<int>(random.uniform_index(static_cast<std::uint64_t>(std::max(1, octave.cols - side))));
    const int shift_y =
        static_cast<int>(random.uniform_index(static_cast<std::uint64_t>(std::max(1, octave.rows - side))));
    if (octave.cols < side || octave.rows < side)
      cv::resize(octave, octave, {side, side}, 0, 0, cv::INTER_CUBIC);
    const int x = std::min(shift_x, octave.cols - side), y = std::min(shift_y, octave.rows - side);
    all += weight * octave(cv::Rect(x, y, side, side));
  }
  cv::Scalar mean, sd;
  cv::meanStdDev(all, mean, sd);
  all = (all - mean[0]) / std::max(1e-9, sd[0]);
  return field;
}

void add_distractors(Grid<float>& heights, Random& random, double strength) {
  const double many = random.bernoulli(0.3) ? 2.5 : 1;
  for (auto n = random.poisson(1.5 * many); n > 0; --n) add_line(heights, random, strength);
  for (auto n = random.poisson(random.bernoulli(0.4) ? 50 * many : 12 * many); n > 0; --n)
    add_blob(heights, random, strength);
  if (random.bernoulli(0.35)) add_ripples(heights, random, strength);
}

std::vector<LabelledCrater> add_craters(Grid<float>& heights, Grid<float>& bright, Random& random) {
  static const DegradedCraters worn;
  const double side = double(heights.columns()), area = side * side;
  const double slope = random.uniform(1.7, 3.0), smallest = 2, largest = side * 0.28;
  const double oldest = random.uniform(0.15, DegradedCraters::kMaxDiffusionLength);
  // The fraction of the area within rims of 8 to 16 px determines the density.
  const double cover = random.log_uniform(0.01, 0.15);
  const double at_smallest = cover * area / (std::numbers::pi / 4 * 144) /
                             (std::pow(8 / 2.0, -slope) - std::pow(16 / 2.0, -slope)) / 4;
  const auto count = std::min<std::uint64_t>(random.poisson(at_smallest), 30000);
  std::vector<Impact> impacts;
  const auto draw = [&](double x, double y, double radius) {
    impacts.push_back(draw_impact(random, x, y, radius, oldest));
  };
  for (std::uint64_t i = 0; i < count; ++i) {
    const double q = std::pow(largest / smallest, -slope);
    const double diameter = 2 * smallest * std::pow(1 - random.uniform() * (1 - q), -1 / slope);
    draw(random.uniform(0, side), random.uniform(0, side), diameter / 2);
  }
  for (auto n = random.poisson(6); n > 0; --n)  // sizes that are rare under the power law
    draw(random.uniform(0, side), random.uniform(0, side), random.log_uniform(15, 110));
  if (random.bernoulli(0.4))  // a cluster of secondaries
    for (double x = random.uniform(0, side), y = random.uniform(0, side), n = random.uniform(10, 60); n > 0;
         --n)
      draw(x + random.normal(0, 60), y + random.normal(0, 60), random.log_uniform(3, 12));
  std::stable_sort(impacts.begin(), impacts.end(), [](const Impact& a, const Impact& b) {
    return a.diffusion_length * std::sqrt(a.radius) > b.diffusion_length * std::sqrt(b.radius);
  });
  std::vector<LabelledCrater> known;
  for (const Impact& c : impacts) {
    excavate(heights, bright, c, worn);
    const double diameter = 2 * c.radius * worn.crest(c.diffusion_length);
    if (diameter >= 5) known.push_back({c.x, c.y, diameter, c.depth});
  }
  return known;
}

}  // namespace waymark::pipeline

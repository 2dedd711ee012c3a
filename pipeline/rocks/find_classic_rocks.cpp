// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/find_classic_rocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark::pipeline {
namespace {

constexpr std::int64_t kTileSide = 500;
constexpr double kGamma = 1.2;                       // ROSCO's default for HiRISE
constexpr std::size_t kMinArea = 3, kMaxArea = 800;  // pixels
constexpr double kMaxElongation = 4;                 // major / minor
constexpr double kMinContrast = 0.1;                 // of the tile's range, at both ends

enum Shade : char { light_, dark_, taken_ };

// Marks the dark pixels of one tile; returns the range of its brightness.
double mark_dark(const Pixels& image, const Window& tile, Grid<char>& shade) {
  float low = 0, high = 0;
  bool any = false;
  for (std::int64_t y = tile.row; y < tile.end_row(); ++y)
    for (std::int64_t x = tile.column; x < tile.end_column(); ++x) {
      const float v = image(x, y);
      if (!std::isfinite(v)) continue;
      low = any ? std::min(low, v) : v;
      high = any ? std::max(high, v) : v;
      any = true;
    }
  const double range = static_cast<double>(high - low);
  if (!any || !(range > 0)) return 0;
  const auto bin = [&](float v) {
    const double fraction = std::clamp(static_cast<double>(v - low) / range, 0.0, 1.0);
    return static_cast<int>(255.999 * std::pow(fraction, kGamma));
  };
  std::array<double, 256> histogram{};
  for (std::int64_t y = tile.row; y < tile.end_row(); ++y)
    for (std::int64_t x = tile.column; x < tile.end_column(); ++x)
      if (std::isfinite(image(x, y))) ++histogram[static_cast<std::size_t>(bin(image(x, y)))];
  const int threshold = maximum_entropy_threshold(histogram);
  for (std::int64_t y = tile.row; y < tile.end_row(); ++y)
    for (std::int64_t x = tile.column; x < tile.end_column(); ++x)
      if (std::isfinite(image(x, y)) && bin(image(x, y)) <= threshold) shade(x, y) = dark_;
  return range;
}

struct Pixel {
  std::int64_t x, y;
};

// Returns the 4-connected dark area that contains a pixel and marks it as taken.
std::vector<Pixel> dark_area(Grid<char>& shade, Pixel from) {
  std::vector<Pixel> area{from};
  shade(from.x, from.y) = taken_;
  for (std::size_t i = 0; i < area.size(); ++i)
    for (const auto& [dx, dy] : {Pixel{1, 0}, Pixel{-1, 0}, Pixel{0, 1}, Pixel{0, -1}}) {
      const Pixel next{area[i].x + dx, area[i].y + dy};
      if (!shade.contains(next.x, next.y) || shade(next.x, next.y) != dark_) continue;
      shade(next.x, next.y) = taken_;
      area.push_back(next);
    }
  return area;
}

double bright(const Pixels& image, double x, double y) {
  const auto u = std::clamp<std::int64_t>(std::lround(x), 0, image.columns() - 1);
  const auto v = std::clamp<std::int64_t>(std::lround(y), 0, image.rows() - 1);
  return static_cast<double>(image(u, v));
}

std::optional<Detection> rock_of(const Pixels& image, const std::vector<Pixel>& area, const LightFrame& light,
                                 double range) {
  if (area.size() < kMinArea || area.size() > kMaxArea) return std::nullopt;
  double x = 0, y = 0, tt = 0, ss = 0, st = 0;
  const auto count = static_cast<double>(area.size());
  for (const Pixel& p : area) {
    x += static_cast<double>(p.x) / count;
    y += static_cast<double>(p.y) / count;
  }
  for (const Pixel& p : area) {
    const double dx = static_cast<double>(p.x) - x, dy = static_cast<double>(p.y) - y;
    const double t = light.along(dx, dy), s = light.across(dx, dy);
    tt += t * t / count;
    ss += s * s / count;
    st += s * t / count;
  }
  tt += 1.0 / 12;
  ss += 1.0 / 12;
  const double root = std::sqrt((tt - ss) * (tt - ss) / 4 + st * st), mean = (tt + ss) / 2;
  const double major = mean + root, minor = std::max(1e-6, mean - root);
  if (std::sqrt(major / minor) > kMaxElongation) return std::nullopt;
  // Half extents of the ellipse along and across the light, scaled to the area.
  const double scale = std::sqrt(count / (std::numbers::pi * 4 * std::sqrt(major * minor)));
  const double half_along = 2 * scale * std::sqrt(tt), half_across = 2 * scale * std::sqrt(ss);
  const auto at = [&](double t) { return bright(image, x + light.ux * t, y + light.uy * t); };
  const double middle = at(0);
  const double front = (at(-half_along - 1.5) - middle) / range,
               back = (at(half_along + 1.5) - middle) / range;
  if (!(std::min(front, back) > kMinContrast)) return std::nullopt;
  Detection rock;
  rock.outline = {.x = x - light.ux * half_along,
                  .y = y - light.uy * half_along,
                  .major = 2 * half_across,
                  .minor = 2 * half_across,
                  .angle = 0};
  rock.covariance = Eigen::Matrix2d::Identity() * std::pow(std::hypot(0.5, 0.3 * half_across), 2);
  rock.diameter_sd = std::hypot(0.6, 0.2 * half_across);
  rock.shadow_reach = MeasuredValue{2 * half_along, std::hypot(0.8, 0.4 * half_along)};
  rock.confidence = std::clamp(2 * std::min(front, back), 0.01, 1.0);
  return rock;
}

}  // namespace

int maximum_entropy_threshold(std::span<const double> histogram) {
  double total = 0;
  for (const double n : histogram) total += n;
  if (!(total > 0)) return 0;
  const auto entropy_term = [&](double n) { return n > 0 ? -n / total * std::log(n / total) : 0; };
  double all = 0;
  for (const double n : histogram) all += entropy_term(n);
  double below = 0, fraction = 0, max_sum = -1;
  int best = 0;
  for (std::size_t i = 0; i + 1 < histogram.size(); ++i) {
    below += entropy_term(histogram[i]);
    fraction += histogram[i] / total;
    if (!(fraction > 0) || !(fraction < 1 - 1e-12)) continue;
    const double sum =
        std::log(fraction) + below / fraction + std::log(1 - fraction) + (all - below) / (1 - fraction);
    if (sum > max_sum) {
      max_sum = sum;
      best = static_cast<int>(i);
    }
  }
  return best;
}

std::vector<Detection> find_classic_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle) {
  const LightFrame light = LightFrame::of(sun_angle);
  Grid<char> shade(image.columns(), image.rows(), light_);
  const std::int64_t tile_columns = (image.columns() + kTileSide - 1) / kTileSide;
  std::vector<double> range;
  for (std::int64_t row = 0; row < image.rows(); row += kTileSide)
    for (std::int64_t column = 0; column < image.columns(); column += kTileSide)
      range.push_back(mark_dark(image,
                                {column, row, std::min(kTileSide, image.columns() - column),
                                 std::min(kTileSide, image.rows() - row)},
                                shade));
  std::vector<Detection> found;
  for (std::int64_t y = 0; y < image.rows(); ++y)
    for (std::int64_t x = 0; x < image.columns(); ++x) {
      if (shade(x, y) != dark_) continue;
      const auto area = dark_area(shade, {x, y});
      auto rock = rock_of(image, area, light,
                          range[static_cast<std::size_t>((y / kTileSide) * tile_columns + x / kTileSide)]);
      if (!rock) continue;
      const double diameter = rock->outline.diameter();
      if (diameter < search.min_diameter || diameter > search.max_diameter ||
          rock->confidence < search.min_confidence)
        continue;
      rock->type = search.type;
      found.push_back(*rock);
    }
  return found;
}

}  // namespace waymark::pipeline

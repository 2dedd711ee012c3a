// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/synthetic_rock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/rocks/shadow_shape.hpp"
namespace waymark::pipeline {
namespace {

// Shadow fraction at a point `t` away from the sun and `s` across, from the centre of the rock. Scaled
// vertically by radius / height the half ellipsoid is a hemisphere, whose shadow on the ground is the half
// ellipse of half axes r across and sqrt(r^2 + reach^2) along.
double ellipsoid_alpha(const SyntheticRock& rock, double tan_elevation, double s, double t) {
  const double r = rock.radius, q = s * s + t * t;
  if (q >= r * r) {
    const double a2 = r * r + rock.reach * rock.reach;
    return t > 0 && s * s / (r * r) + t * t / a2 < 1 ? 1 : 0;
  }
  const double height = std::max(1e-6, rock.reach * tan_elevation);
  const double z = std::sqrt(std::max(0.0, 1 - q / (r * r)));  // of the unit hemisphere
  const double nt = t / (r * r), ns = s / (r * r), nz = z / height;
  const double norm = std::sqrt(nt * nt + ns * ns + nz * nz);
  const double cos_e = 1 / std::hypot(1.0, tan_elevation), sin_e = tan_elevation * cos_e;
  const double light = std::max(0.0, (nz * sin_e - nt * cos_e) / norm) / sin_e;
  return 1 - light;
}

double cylinder_alpha(const SyntheticRock& rock, double s, double t) {
  const double r = rock.radius;
  if (std::abs(s) >= r || s * s + t * t < r * r) return 0;  // the flat top is as bright as the ground
  const double chord = std::sqrt(r * r - s * s);
  return t > 0 && t < rock.reach + chord ? 1 : 0;
}

// Cells beyond the border count as 0. Weights are in the outer loop, so that the inner one vectorises; the
// order of each sum is that of the weights.
void blur_rows(std::vector<float>& cells, std::int64_t w, const std::vector<float>& mask) {
  const auto half = static_cast<std::int64_t>(mask.size() / 2);
  const auto h = static_cast<std::int64_t>(cells.size()) / w;
  std::vector<float> line(static_cast<std::size_t>(w + 2 * half), 0.0F);
  for (std::int64_t y = 0; y < h; ++y) {
    float* const row = &cells[static_cast<std::size_t>(y * w)];
    std::copy_n(row, w, line.begin() + half);
    std::fill_n(row, w, 0.0F);
    for (std::size_t k = 0; k < mask.size(); ++k) {
      const float weight = mask[k];
      const float* const from = line.data() + k;
      for (std::int64_t x = 0; x < w; ++x) row[x] += weight * from[x];
    }
  }
}

void blur_columns(std::vector<float>& cells, std::int64_t w, const std::vector<float>& mask) {
  const auto half = static_cast<std::int64_t>(mask.size() / 2);
  const auto h = static_cast<std::int64_t>(cells.size()) / w;
  const std::vector<float> source = cells;
  std::fill(cells.begin(), cells.end(), 0.0F);
  for (std::int64_t y = 0; y < h; ++y)
    for (std::int64_t v = std::max<std::int64_t>(0, y - half); v <= std::min(h - 1, y + half); ++v) {
      const float weight = mask[static_cast<std::size_t>(v - y + half)];
      const float* const from = &source[static_cast<std::size_t>(v * w)];
      float* const to = &cells[static_cast<std::size_t>(y * w)];
      for (std::int64_t x = 0; x < w; ++x) to[x] += weight * from[x];
    }
}

std::vector<float> gaussian(double sd) {
  const auto half = static_cast<std::int64_t>(std::ceil(3 * sd));
  std::vector<float> mask;
  float sum = 0;
  for (std::int64_t k = -half; k <= half; ++k) {
    const double z = static_cast<double>(k) / std::max(sd, 1e-9);
    mask.push_back(static_cast<float>(std::exp(-0.5 * z * z)));
    sum += mask.back();
  }
  for (float& weight : mask) weight /= sum;
  return mask;
}

}  // namespace

Grid<float> render_rock_shadow(const SyntheticRock& rock, std::int64_t columns, std::int64_t rows) {
  const int fine = rock.radius < 1   ? 6
                   : rock.radius < 2 ? 4
                   : rock.radius < 5 ? 3
                                     : 2;  // samples per pixel and direction
  const LightFrame light = LightFrame::of(rock.sun_angle);
  const double tan_elevation = std::tan(rock.elevation.value);
  const std::int64_t w = columns * fine, h = rows * fine;
  std::vector<float> cells(static_cast<std::size_t>(w * h));
  for (std::int64_t v = 0; v < h; ++v)
    for (std::int64_t u = 0; u < w; ++u) {
      const double x = (static_cast<double>(u) + 0.5) / fine - 0.5 - rock.x;
      const double y = (static_cast<double>(v) + 0.5) / fine - 0.5 - rock.y;
      const double t = light.along(x, y), s = light.across(x, y);
      const double alpha =
          rock.upright ? cylinder_alpha(rock, s, t) : ellipsoid_alpha(rock, tan_elevation, s, t);
      cells[static_cast<std::size_t>(v * w + u)] = static_cast<float>(std::max(-1.5, alpha));
    }
  const std::vector<float> mask = gaussian(rock.blur * fine);
  blur_rows(cells, w, mask);
  blur_columns(cells, w, mask);
  Grid<float> picture(columns, rows);
  for (std::int64_t v = 0; v < h; ++v)
    for (std::int64_t u = 0; u < w; ++u)
      picture(u / fine, v / fine) +=
          cells[static_cast<std::size_t>(v * w + u)] / static_cast<float>(fine * fine);
  return picture;
}

}  // namespace waymark::pipeline

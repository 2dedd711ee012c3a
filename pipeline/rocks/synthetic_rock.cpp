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

void blur_lines(std::vector<float>& cells, std::int64_t count, std::int64_t step, std::int64_t lines,
                std::int64_t line_step, const std::vector<float>& mask) {
  std::vector<float> line(static_cast<std::size_t>(count));
  const auto half = static_cast<std::int64_t>(mask.size() / 2);
  for (std::int64_t l = 0; l < lines; ++l) {
    for (std::int64_t i = 0; i < count; ++i)
      line[static_cast<std::size_t>(i)] = cells[static_cast<std::size_t>(l * line_step + i * step)];
    for (std::int64_t i = 0; i < count; ++i) {
      float sum = 0;
      const std::int64_t from = std::max<std::int64_t>(-half, -i), to = std::min(half, count - 1 - i);
      for (std::int64_t k = from; k <= to; ++k)
        sum += mask[static_cast<std::size_t>(k + half)] * line[static_cast<std::size_t>(i + k)];
      cells[static_cast<std::size_t>(l * line_step + i * step)] = sum;
    }
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
  blur_lines(cells, w, 1, h, w, mask);
  blur_lines(cells, h, w, w, 1, mask);
  Grid<float> picture(columns, rows);
  for (std::int64_t v = 0; v < h; ++v)
    for (std::int64_t u = 0; u < w; ++u)
      picture(u / fine, v / fine) +=
          cells[static_cast<std::size_t>(v * w + u)] / static_cast<float>(fine * fine);
  return picture;
}

}  // namespace waymark::pipeline

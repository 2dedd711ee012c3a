// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/bowl_template.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace waymark::pipeline {
namespace {

constexpr double kReach = 1.3;        // side of the template / diameter
constexpr int kSamples = 4;           // per pixel and axis
constexpr double kOuterSlope = 0.45;  // slope outside the rim / slope of the wall at the rim
constexpr double kRidge = 0.9;        // same, of a crater that is filled to the plain
constexpr double kDepth = 0.2;        // / diameter, of a fresh simple crater (Pike 1977)
constexpr double kRim = 0.25;         // height of the rim above the plain / depth below it

// Brightness of the slope template at (u, v) radii from the centre, light from +u.
double slope_light(double u, double v) {
  const double r = std::hypot(u, v);
  if (r < 1) return -u;
  return kOuterSlope * u / (r * r * r * r * r);
}

// As slope_light, with a level floor out to `floor` radii inside a wall of equal slope.
double filled_light(double u, double v, double floor, double outer_slope) {
  const double r = std::hypot(u, v);
  if (r < floor) return 0;
  return r < 1 ? -u / r : outer_slope * u / (r * r * r * r * r);
}

// Height of a fresh crater in radii at r radii from its centre.
double height(double r) {
  if (r < 1) return 2 * kDepth * ((1 + kRim) * r * r - 1);
  return 2 * kDepth * kRim / (r * r * r);
}

// Lambert shading with cast shadow, light from +u.
double fresh_light(double u, double v, double elevation) {
  const double here = height(std::hypot(u, v)), rise = std::tan(elevation);
  for (double s = 0.05; s < 2.4; s += 0.05)
    if (height(std::sqrt((u + s) * (u + s) + v * v)) > here + s * rise) return 0;
  constexpr double h = 1e-3;
  const double gx = (height(std::hypot(u + h, v)) - height(std::hypot(u - h, v))) / (2 * h);
  const double gy = (height(std::hypot(u, v + h)) - height(std::hypot(u, v - h))) / (2 * h);
  return std::max(0.0, (std::sin(elevation) - gx * std::cos(elevation)) / std::sqrt(1 + gx * gx + gy * gy));
}

}  // namespace

double bowl_brightness(double u, double v, BowlLight light) {
  switch (light) {
    case BowlLight::slope:
      return slope_light(u, v);
    case BowlLight::low_shadow:
      return fresh_light(u, v, 25 * kRadiansPerDegree);
    case BowlLight::deep_shadow:
      return fresh_light(u, v, 12 * kRadiansPerDegree);
    case BowlLight::flat_floor:
      return filled_light(u, v, 0.65, kOuterSlope);
    case BowlLight::rim_only:
      return filled_light(u, v, 0.75, kRidge);
  }
  return 0;
}

Pixels bowl_template(double diameter, Radians sun_angle, BowlLight light) {
  const int half = static_cast<int>(std::ceil(diameter / 2 * kReach)), side = 2 * half + 1;
  const double towards_x = std::cos(sun_angle.value), towards_y = std::sin(sun_angle.value);
  cv::Mat1f bowl(side, side);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      double sum = 0;
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i) {
          const double x = (column - half + (i + 0.5) / kSamples - 0.5) / (diameter / 2);
          const double y = (row - half + (j + 0.5) / kSamples - 0.5) / (diameter / 2);
          sum += bowl_brightness(x * towards_x + y * towards_y, y * towards_x - x * towards_y, light);
        }
      bowl(row, column) = static_cast<float>(sum);
    }
  cv::GaussianBlur(bowl, bowl, {}, 0.7);
  bowl -= cv::mean(bowl)[0];
  bowl /= cv::norm(bowl);
  Pixels result(side, side);
  bowl.copyTo(cv::Mat1f(side, side, result.cells().data()));
  return result;
}

}  // namespace waymark::pipeline

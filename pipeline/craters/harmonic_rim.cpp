// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/harmonic_rim.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark::pipeline {
namespace {

using Harmonics = Eigen::Matrix<double, 5, 1>;

Harmonics harmonics(double azimuth) {
  return {1, std::cos(azimuth), std::sin(azimuth), std::cos(2 * azimuth), std::sin(2 * azimuth)};
}

}  // namespace

double RimShape::radius(double azimuth) const {
  return harmonics(azimuth).dot(terms);
}

PixelEllipse RimShape::ellipse(double x, double y, double circle) const {
  const double r0 = terms[0] * circle, stretch = std::min(0.4 * r0, std::hypot(terms[3], terms[4]) * circle);
  PixelEllipse e{.x = x + terms[1] * circle,
                 .y = y + terms[2] * circle,
                 .major = 2 * (r0 + stretch),
                 .minor = 2 * (r0 - stretch),
                 .angle = std::atan2(terms[4], terms[3]) / 2};
  if (e.angle <= -std::numbers::pi / 2) e.angle += std::numbers::pi;
  return e;
}

RimShape fit_rim(const std::vector<RimPoint>& points, double full_weight) {
  // Prior: sd of size, shift and ellipticity, radii.
  constexpr std::array<double, 5> prior{0.15, 0.15, 0.15, 0.04, 0.04};
  Harmonics shape = Harmonics::Zero();
  shape[0] = 1;
  double noise = 0.1;
  Eigen::Matrix<double, 5, 5> information;
  for (int round = 0; round < 6; ++round) {
    information.setZero();
    Harmonics right = Harmonics::Zero();
    for (int i = 0; i < 5; ++i) {
      information(i, i) = 1 / (prior[static_cast<std::size_t>(i)] * prior[static_cast<std::size_t>(i)]);
      right[i] = i == 0 ? information(0, 0) : 0;
    }
    double squares = 0, total = 0;
    for (const RimPoint& p : points) {
      const Harmonics h = harmonics(p.azimuth);
      const double off = p.radius - h.dot(shape), limit = 1.5 * noise;
      const double trust =
          std::min(1.0, p.weight / full_weight) * (std::abs(off) > limit ? limit / std::abs(off) : 1);
      information += trust / (noise * noise) * h * h.transpose();
      right += trust / (noise * noise) * p.radius * h;
      squares += trust * off * off;
      total += trust;
    }
    shape = information.ldlt().solve(right);
    noise = std::clamp(std::sqrt(squares / std::max(1.0, total)), 0.02, 0.2);
  }
  const Eigen::Matrix<double, 5, 5> covariance = information.inverse();
  // Neighbouring azimuths are correlated: about half of them are independent.
  return {shape, std::sqrt(covariance(1, 1) + covariance(2, 2)), std::sqrt(2 * covariance(0, 0))};
}

}  // namespace waymark::pipeline

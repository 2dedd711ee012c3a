// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/dem_rim.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/solve.hpp"
#include "pipeline/craters/harmonic_rim.hpp"
#include "pipeline/craters/sample.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kAzimuths = 24;
constexpr double kNearest = 0.65, kFarthest = 1.4;  // radii
constexpr double kExpected = 0.3;                   // radii

double quantile(std::vector<double> values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Plane through the ring from 1 to 1.6 radii: gradient per cell along x and y.
Eigen::Vector2d tilt(const Pixels& heights, const CraterCandidate& c) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-6;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = 0; i < 2 * kAzimuths; ++i)
    for (const double r : {1.0, 1.3, 1.6}) {
      const double azimuth = std::numbers::pi * i / kAzimuths;
      const double dx = r * std::cos(azimuth), dy = r * std::sin(azimuth);
      const double x = c.x + dx * c.diameter / 2, y = c.y + dy * c.diameter / 2;
      if (x < 0 || y < 0 || x > double(heights.columns() - 1) || y > double(heights.rows() - 1)) continue;
      const Eigen::Vector3d at{1, dx, dy};
      normal += at * at.transpose();
      right += at * double(sample(heights, x, y));
    }
  const Eigen::Vector3d plane = solve_symmetric(normal, right);
  return {plane[1] / (c.diameter / 2), plane[2] / (c.diameter / 2)};
}

struct Crest {
  double azimuth, radius, height, trust;
};

}  // namespace

std::optional<DemRim> measure_dem_rim(const Pixels& heights, const CraterCandidate& candidate) {
  CraterCandidate c = candidate;
  DemRim rim;
  std::vector<Crest> crests;
  RimShape shape;
  for (int pass = 0; pass < 2; ++pass) {
    const double radius = c.diameter / 2, step = std::max(0.03, 0.3 / radius);
    const Eigen::Vector2d slope = tilt(heights, c);
    const auto height = [&](double dx, double dy) {
      return sample(heights, c.x + dx, c.y + dy) - slope.x() * dx - slope.y() * dy;
    };
    std::vector<double> floor;
    for (int i = 0; i < kAzimuths; ++i)
      for (double r = 0.05; r <= 0.5; r += 0.15) {
        const double azimuth = 2 * std::numbers::pi * i / kAzimuths;
        floor.push_back(height(r * radius * std::cos(azimuth), r * radius * std::sin(azimuth)));
      }
    const double bottom = quantile(floor, 0.2);
    crests.clear();
    std::vector<RimPoint> points;
    for (int i = 0; i < kAzimuths; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / kAzimuths, ux = std::cos(azimuth),
                   uy = std::sin(azimuth);
      const double far_x = c.x + radius * ux, far_y = c.y + radius * uy;
      if (far_x < 0 || far_y < 0 || far_x > double(heights.columns() - 1) ||
          far_y > double(heights.rows() - 1))
        continue;
      double best = -1e300, at = 1, top = 0;
      for (double r = kNearest; r <= kFarthest; r += step) {
        const double h = height(r * radius * ux, r * radius * uy) - bottom, off = (r - 1) / kExpected;
        const double score = h * std::exp(-0.5 * off * off);
        if (score > best) best = score, at = r, top = h;
      }
      crests.push_back({azimuth, at, top, 1});
      points.push_back({azimuth, at, 1});
    }
    if (crests.size() < kAzimuths / 2) return {};
    shape = fit_rim(points, 1);
    rim.known_fraction = double(crests.size()) / kAzimuths;
    std::vector<double> rises;
    for (const Crest& crest : crests) rises.push_back(crest.height);
    rim.depth = quantile(rises, 0.5);
    rim.low_rim = quantile(rises, 0.15);
    rim.rim_height = bottom + rim.depth;
    rim.depth_sd = (quantile(rises, 0.84) - quantile(rises, 0.16)) / 2 / std::sqrt(double(rises.size()) / 3);
    double squares = 0;
    for (const RimPoint& p : points) squares += std::pow(p.radius - shape.radius(p.azimuth), 2);
    rim.spread = std::sqrt(squares / double(points.size()));
    const PixelEllipse e = shape.ellipse(c.x, c.y, radius);
    rim.x = e.x, rim.y = e.y, rim.major = e.major, rim.minor = e.minor, rim.angle = e.angle;
    if (pass == 0) c = {e.x, e.y, std::clamp(e.diameter(), 0.75 * c.diameter, 1.3 * c.diameter), c.score};
  }
  return rim;
}

}  // namespace waymark::pipeline

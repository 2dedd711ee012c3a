// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/rim_refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/craters/harmonic_rim.hpp"
#include "pipeline/craters/sample.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kAzimuths = 36;
constexpr double kNearest = 0.6, kFarthest = 1.45;  // radii
constexpr double kExpected = 0.18;                  // sd of the crest about the candidate's circle, radii
constexpr double kSunward = 0.35;  // minimum |cosine| between azimuth and light for an edge to be visible

// Position of the steepest outward change of `sign` brightness along one azimuth.
std::optional<RimPoint> edge(const Pixels& image, const CraterCandidate& c, double azimuth, double sign) {
  const double radius = c.diameter / 2, step = std::max(0.03, 0.5 / radius);  // radii
  const double towards_x = std::cos(azimuth), towards_y = std::sin(azimuth);
  const auto count = static_cast<std::size_t>((kFarthest - kNearest) / step) + 1;
  // Slope over about 0.1 radii or 1.5 px, whichever is larger.
  const double half = std::max(0.06, 0.75 / radius);
  const bool inside = is_inside(image, c.x, c.y, (kFarthest + half) * radius + 1);
  const auto brightness = [&](double r) {
    const double x = c.x + r * radius * towards_x, y = c.y + r * radius * towards_y;
    return inside ? sample_inside(image.cells().data(), image.columns(), x, y) : sample(image, x, y);
  };
  std::vector<double> steepness(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double r = kNearest + double(i) * step, from_circle = (r - 1) / kExpected;
    steepness[i] =
        sign * (brightness(r + half) - brightness(r - half)) * std::exp(-0.5 * from_circle * from_circle);
  }
  const auto best = std::max_element(steepness.begin() + 1, steepness.end() - 1);
  if (!(*best > 0)) return {};
  const double bend = best[-1] - 2 * best[0] + best[1];
  const double offset = bend < 0 ? std::clamp(0.5 * (best[-1] - best[1]) / bend, -1.0, 1.0) : 0;
  return RimPoint{azimuth, kNearest + (double(best - steepness.begin()) + offset) * step, *best};
}

}  // namespace

std::optional<Rim> refine_rim(const Pixels& image, const CraterCandidate& candidate, Radians sun_angle) {
  CraterCandidate about = candidate;
  RimShape found;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<RimPoint> points;
    double total = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      const double azimuth = 2 * std::numbers::pi * i / kAzimuths,
                   facing = std::cos(azimuth - sun_angle.value);
      if (std::abs(facing) < kSunward) continue;
      auto point = edge(image, about, azimuth, facing > 0 ? 1 : -1);
      if (!point) continue;
      total += point->weight;
      point->weight *= std::abs(facing);
      points.push_back(*point);
    }
    if (points.size() < 8) return {};
    found = fit_rim(points, total / double(points.size()));
    const double radius = about.diameter / 2;
    if (pass == 0) {
      about.x += found.terms[1] * radius;
      about.y += found.terms[2] * radius;
      about.diameter *= std::clamp(found.terms[0], 0.75, 1.3);
    }
  }
  const double radius = about.diameter / 2;
  Rim rim;
  rim.ellipse = found.ellipse(about.x, about.y, radius);
  rim.centre_sd = found.centre_sd * radius / std::numbers::sqrt2;
  rim.diameter_sd = 2 * found.radius_sd * radius;
  const double moved = std::hypot(rim.ellipse.x - candidate.x, rim.ellipse.y - candidate.y);
  const double grown = rim.ellipse.diameter() / candidate.diameter;
  if (!(moved < 0.15 * candidate.diameter) || !(grown > 0.7 && grown < 1.35)) return {};
  return rim;
}

}  // namespace waymark::pipeline

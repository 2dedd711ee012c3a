// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>

#include "pipeline/craters/kept_circles.hpp"

namespace waymark::pipeline {
double overlap(const CraterCandidate& a, const CraterCandidate& b) {
  const double r = std::min(a.diameter, b.diameter) / 2, s = std::max(a.diameter, b.diameter) / 2;
  const double d = std::hypot(a.x - b.x, a.y - b.y);
  constexpr double pi = std::numbers::pi;
  if (!(r > 0) || d >= r + s) return 0;
  if (d <= s - r) return r * r / (s * s);
  const double p = std::acos(std::clamp((d * d + r * r - s * s) / (2 * d * r), -1.0, 1.0));
  const double q = std::acos(std::clamp((d * d + s * s - r * r) / (2 * d * s), -1.0, 1.0));
  const double kite = std::sqrt(std::max(0.0, (r + s - d) * (d + r - s) * (d - r + s) * (d + r + s))) / 2;
  const double common = r * r * p + s * s * q - kite;
  return common / (pi * (r * r + s * s) - common);
}

void sort_by_score(std::vector<CraterCandidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const CraterCandidate& a, const CraterCandidate& b) {
    return std::tie(b.score, a.y, a.x, a.diameter) < std::tie(a.score, b.y, b.x, b.diameter);
  });
}

bool same_rim(const CraterCandidate& a, const CraterCandidate& b, double max_overlap) {
  const double small = std::min(a.diameter, b.diameter), large = std::max(a.diameter, b.diameter);
  const double dx = a.x - b.x, dy = a.y - b.y;
  if (dx * dx + dy * dy >= (small + large) * (small + large) / 4) return false;
  if (large < 2 * small && dx * dx + dy * dy < small * small / 16) return true;
  return overlap(a, b) > max_overlap;
}

std::vector<CraterCandidate> suppress_overlaps(std::vector<CraterCandidate> candidates, double max_overlap) {
  sort_by_score(candidates);
  KeptCircles kept;
  std::vector<CraterCandidate> result;
  for (const CraterCandidate& c : candidates) {
    const auto is_repeat = [&](const CraterCandidate& k, std::size_t) { return same_rim(k, c, max_overlap); };
    if (kept.any_near(c, max_overlap, is_repeat)) continue;
    kept.add(c);
    result.push_back(c);
  }
  return result;
}

}  // namespace waymark::pipeline

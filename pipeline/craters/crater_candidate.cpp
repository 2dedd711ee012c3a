// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/crater_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <unordered_map>

namespace waymark::pipeline {
namespace {

int octave(double diameter) {
  return static_cast<int>(std::floor(std::log2(std::max(diameter, 1e-3))));
}

// Index of kept circles by octave of diameter, in cells as large as the largest diameter of the octave.
class KeptCircles {
 public:
  bool has_duplicate(const CraterCandidate& c, double max_overlap) const {
    // Beyond one octave the overlap is below 1/4 and the centre rule does not apply; lower limits need more
    // octaves.
    const int reach =
        1 + static_cast<int>(std::ceil(-std::log2(std::clamp(max_overlap, 0.01, 0.25)) / 2 - 1));
    for (int o = octave(c.diameter) - reach; o <= octave(c.diameter) + reach; ++o) {
      const double size = std::exp2(o + 1);
      const auto rings = static_cast<std::int64_t>(std::ceil((c.diameter + size) / 2 / size));
      const std::int64_t column = cell(c.x, size), row = cell(c.y, size);
      for (std::int64_t j = row - rings; j <= row + rings; ++j)
        for (std::int64_t i = column - rings; i <= column + rings; ++i) {
          const auto found = cells_.find(key(o, i, j));
          if (found == cells_.end()) continue;
          for (const CraterCandidate& k : found->second)
            if (same_rim(k, c, max_overlap)) return true;
        }
    }
    return false;
  }
  void add(const CraterCandidate& c) {
    const int o = octave(c.diameter);
    const double size = std::exp2(o + 1);
    cells_[key(o, cell(c.x, size), cell(c.y, size))].push_back(c);
  }

 private:
  static std::int64_t cell(double at, double size) {
    return static_cast<std::int64_t>(std::floor(at / size));
  }
  static std::int64_t key(int o, std::int64_t column, std::int64_t row) {
    return ((static_cast<std::int64_t>(o) + 16) << 56) ^ ((column & 0xfffffff) << 28) ^ (row & 0xfffffff);
  }
  std::unordered_map<std::int64_t, std::vector<CraterCandidate>> cells_;
};

}  // namespace

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
    if (kept.has_duplicate(c, max_overlap)) continue;
    kept.add(c);
    result.push_back(c);
  }
  return result;
}

}  // namespace waymark::pipeline

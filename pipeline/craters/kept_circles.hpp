// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark::pipeline {

/// Index of circles by octave of diameter, in cells as large as the largest diameter of the octave.
class KeptCircles {
 public:
  /// Returns whether `is_repeat(circle, index)` holds for a kept circle that may touch `c`. Circles that
  /// differ by more octaves than an intersection over union of `min_overlap` allows may be left out.
  template <class IsRepeat>
  bool any_near(const CraterCandidate& c, double min_overlap, const IsRepeat& is_repeat) const {
    // Beyond one octave the overlap is below 1/4; lower limits need more octaves.
    const int reach =
        1 + static_cast<int>(std::ceil(-std::log2(std::clamp(min_overlap, 0.01, 0.25)) / 2 - 1));
    for (int o = octave(c.diameter) - reach; o <= octave(c.diameter) + reach; ++o) {
      const double size = std::exp2(o + 1);
      const auto rings = static_cast<std::int64_t>(std::ceil((c.diameter + size) / 2 / size));
      const std::int64_t column = cell(c.x, size), row = cell(c.y, size);
      for (std::int64_t j = row - rings; j <= row + rings; ++j)
        for (std::int64_t i = column - rings; i <= column + rings; ++i) {
          const auto found = cells_.find(key(o, i, j));
          if (found == cells_.end()) continue;
          for (const Kept& kept : found->second)
            if (is_repeat(kept.circle, kept.index)) return true;
        }
    }
    return false;
  }
  void add(const CraterCandidate& c, std::size_t index = 0) {
    const int o = octave(c.diameter);
    const double size = std::exp2(o + 1);
    cells_[key(o, cell(c.x, size), cell(c.y, size))].push_back({c, index});
  }

 private:
  struct Kept {
    CraterCandidate circle;
    std::size_t index;
  };
  static int octave(double diameter) {
    return static_cast<int>(std::floor(std::log2(std::max(diameter, 1e-3))));
  }
  static std::int64_t cell(double at, double size) {
    return static_cast<std::int64_t>(std::floor(at / size));
  }
  static std::int64_t key(int o, std::int64_t column, std::int64_t row) {
    return ((static_cast<std::int64_t>(o) + 16) << 56) ^ ((column & 0xfffffff) << 28) ^ (row & 0xfffffff);
  }
  std::unordered_map<std::int64_t, std::vector<Kept>> cells_;
};

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <utility>
namespace waymark::importers {

/// The median of five recent numbers. A new number replaces the largest or the smallest of them, in turn
/// as it lies on either side of the median.
class RunningMedian {
 public:
  std::int32_t get() const { return sorted_[2]; }

  void add(std::int32_t v) {
    const std::int32_t median = sorted_[2];
    if (drop_largest_) {
      sorted_[4] = v;
      for (std::size_t i = 4; i > 0 && sorted_[i] < sorted_[i - 1]; --i)
        std::swap(sorted_[i], sorted_[i - 1]);
      drop_largest_ = v < median;
    } else {
      sorted_[0] = v;
      for (std::size_t i = 0; i < 4 && sorted_[i] > sorted_[i + 1]; ++i)
        std::swap(sorted_[i], sorted_[i + 1]);
      drop_largest_ = v <= median;
    }
  }

 private:
  std::array<std::int32_t, 5> sorted_{};
  bool drop_largest_ = true;
};

}  // namespace waymark::importers

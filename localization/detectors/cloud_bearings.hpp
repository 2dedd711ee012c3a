// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>
#include "localization/laser_scan.hpp"
namespace waymark::localization {

/// Points of a 3-D scan, sorted by bearing: what stands before, behind and beside an object.
class CloudBearings {
 public:
  /// Leaves out points that are not finite. 4 ms for 125,000 points.
  explicit CloudBearings(std::span<const Eigen::Vector3f> points);

  /// Calls take(off, slope, range) for each point whose bearing differs from `bearing` by at most `reach`
  /// (rad, below pi).
  /// - `off`: that difference, rad; to the left it is positive.
  /// - `slope`: tangent of the elevation. `range`: level, m.
  template <class Take>
  void within(double bearing, double reach, const Take& take) const {
    const auto first = static_cast<std::int64_t>(std::floor((bearing - reach) / kBin)),
               last = static_cast<std::int64_t>(std::floor((bearing + reach) / kBin));
    for (std::int64_t bin = first; bin <= last; ++bin) {
      const auto b = static_cast<std::size_t>(((bin % kBins) + kBins) % kBins);
      for (std::uint32_t i = starts_[b]; i < starts_[b + 1]; ++i) {
        const double off =
            std::remainder(static_cast<double>(seen_[i].bearing) - bearing, 2 * std::numbers::pi);
        if (std::abs(off) <= reach)
          take(off, static_cast<double>(seen_[i].slope), static_cast<double>(seen_[i].range));
      }
    }
  }

 private:
  static constexpr std::int64_t kBins = 720;
  static constexpr double kBin = 2 * std::numbers::pi / kBins;  // rad

  struct Seen {
    float bearing, slope, range;
  };
  std::vector<std::uint32_t> starts_;
  std::vector<Seen> seen_;
};

}  // namespace waymark::localization

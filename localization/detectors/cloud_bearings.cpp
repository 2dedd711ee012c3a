// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_bearings.hpp"

#include <algorithm>
#include <numeric>

namespace waymark::localization {

CloudBearings::CloudBearings(std::span<const Eigen::Vector3f> points) {
  starts_.assign(static_cast<std::size_t>(kBins) + 1, 0);
  std::vector<Seen> all;
  std::vector<std::uint32_t> bin_of;
  all.reserve(points.size()), bin_of.reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    const float range = p.head<2>().norm(), slope = p.z() / range;
    if (!std::isfinite(range) || !std::isfinite(slope)) continue;
    const float bearing = std::atan2(p.y(), p.x());
    const auto bin = static_cast<std::int64_t>(std::floor(static_cast<double>(bearing) / kBin));
    all.push_back({bearing, slope, range});
    bin_of.push_back(static_cast<std::uint32_t>((bin + kBins) % kBins));
    ++starts_[bin_of.back() + 1];
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  seen_.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) seen_[next[bin_of[i]]++] = all[i];
}

}  // namespace waymark::localization

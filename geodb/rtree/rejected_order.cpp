// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/rejected_order.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "core/observation_order.hpp"

namespace waymark::geodb {

RejectedOrder::RejectedOrder(const LandmarkParts& parts, std::size_t max_in_memory) : parts_(&parts) {
  if (!parts.rejected) return;
  for (std::size_t part = 0; part < parts.count; ++part) {
    const auto observations = parts.rejected(part);
    for (const Observation& o : *observations) {
      types_.insert(o.type);
      if (o.position.xyz.allFinite()) extent_.add(o.position.xyz.x(), o.position.xyz.y());
    }
  }
  if (types_.empty()) return;
  const auto positions = [&](std::size_t part, const auto& look) {
    const auto observations = parts_->rejected(part);
    for (const Observation& o : *observations)
      look(o.position.xyz.allFinite() ? o.position.xyz.head<2>().eval()
                                      : Eigen::Vector2d(extent_.min_x, extent_.min_y));
  };
  ranges_ = divide_hilbert_curve(parts.count, positions, extent_, max_in_memory);
}

/// Unknown positions are those of the south-western corner.
std::uint32_t RejectedOrder::curve_position(const Observation& o) const {
  if (!o.position.xyz.allFinite()) return hilbert_position({extent_.min_x, extent_.min_y}, extent_);
  return hilbert_position(o.position.xyz.head<2>(), extent_);
}

void RejectedOrder::visit(const std::function<void(const Observation&)>& take) const {
  for (const HilbertRange& range : ranges_) {
    std::deque<std::pair<std::uint32_t, Observation>> all;
    for (const std::uint32_t part : range.parts) {
      const auto observations = parts_->rejected(part);
      for (const Observation& o : *observations)
        if (const std::uint32_t at = curve_position(o); range.contains(at)) all.emplace_back(at, o);
    }
    std::ranges::sort(all, [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : comes_before(a.second, b.second);
    });
    for (const auto& [_, observation] : all) take(observation);
  }
}

}  // namespace waymark::geodb

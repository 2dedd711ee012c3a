// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline_index.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::localization {
namespace {

Eigen::AlignedBox2d bounds(const std::vector<SkylineSummit>& summits) {
  Eigen::AlignedBox2d box;
  if (summits.size() < 3) return box;
  for (const SkylineSummit& s : summits) box.extend(s.at);
  return box;
}

constexpr double kMaxPlaces = 60000, kMinPlaces = 2000;

}  // namespace

SkylineIndex::SkylineIndex(std::vector<SkylineSummit> summits, const TerrainHeight& ground,
                           const SkylineOptions& options)
    : summits_(std::move(summits)), options_(options), terrain_(ground, bounds(summits_), options_.reach) {
  if (summits_.size() < 3 || terrain_.area().isEmpty()) return;
  const Eigen::Vector2d size = terrain_.area().sizes();
  options_.step = std::clamp(options_.step, std::sqrt(size.prod() / kMaxPlaces),
                             std::max(std::sqrt(size.prod() / kMinPlaces), 2 * terrain_.cell()));
  std::vector<Eigen::Vector2d> at;
  for (double y = options_.step / 2; y < size.y(); y += options_.step)
    for (double x = options_.step / 2; x < size.x(); x += options_.step)
      at.push_back(terrain_.area().min() + Eigen::Vector2d(x, y));
  viewpoints_ = compute_horizons(terrain_, at, options_.step, options_);
}

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_columns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/median.hpp"

namespace waymark::localization {
namespace {

constexpr float kRow = 0.001F;  // rad between points of a row, in elevation
constexpr float kMaxSlope = 2;
constexpr int kSampledRows = 8;    // one of so many is looked at
constexpr float kMaxStep = 0.03F;  // rad: what is farther apart are no neighbours

}  // namespace

double column_step(const PointCloud& cloud) {
  std::vector<std::pair<int, float>> sampled;  // row and azimuth
  for (const Eigen::Vector3f& p : cloud.points) {
    const float slope = p.z() / p.head<2>().norm();
    if (!(std::abs(slope) < kMaxSlope)) continue;
    const int row = static_cast<int>(std::floor(slope / kRow));
    if (row % kSampledRows == 0) sampled.emplace_back(row, std::atan2(p.y(), p.x()));
  }
  std::ranges::sort(sampled);
  std::vector<double> steps;
  for (std::size_t i = 1; i < sampled.size(); ++i)
    if (const float step = sampled[i].second - sampled[i - 1].second;
        sampled[i].first == sampled[i - 1].first && step < kMaxStep)
      steps.push_back(static_cast<double>(step));
  return steps.empty() ? 0 : median(std::move(steps));
}

}  // namespace waymark::localization

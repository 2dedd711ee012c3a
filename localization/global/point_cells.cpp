// SPDX-License-Identifier: Apache-2.0
#include "localization/global/point_cells.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace waymark::localization {

PointCells::PointCells(std::span<const Eigen::Vector3d> points, double cell) {
  if (points.empty()) return;
  Eigen::Vector3d low = points[0], high = points[0];
  for (const Eigen::Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Eigen::Vector3d size = high - low;
  flat_ = low.z() == 0 && high.z() == 0;
  const double count = static_cast<double>(points.size());
  const double faces = size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  if (!(cell > 0)) cell = std::max(std::sqrt(2 * faces / count), 2 * size.maxCoeff() / (count + 1));
  cell_ = std::max({cell, size.maxCoeff() * 1e-12, 1e-6});

  std::vector<std::uint64_t> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d c = (points[i] / cell_).array().floor();
    keys[i] = key_of(c.x(), c.y(), c.z());
  }
  first_.assign(std::bit_ceil(points.size()) + 1, 0);
  for (const std::uint64_t key : keys) ++first_[bucket_of(key) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  entries_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    entries_[next[bucket_of(keys[i])]++] = {points[i], keys[i], static_cast<std::uint32_t>(i)};
  std::ranges::sort(keys);
  occupied_ = static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

}  // namespace waymark::localization

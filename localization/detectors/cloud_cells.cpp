// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_cells.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "localization/detectors/cloud_ground.hpp"

namespace waymark::localization {
namespace {

constexpr double kUnit = 4096;  // per metre, and per unit of the largest intensity

struct CellPoint {
  std::uint64_t key;  // row of cells, column, layer
  std::int64_t x, y, z, height, intensity;
};

std::int64_t whole(double value) {
  return static_cast<std::int64_t>(std::llround(value * kUnit));
}

}  // namespace

CloudCells::CloudCells(const PointCloud& cloud, double max_range, double cell, double min_height,
                       double max_height)
    : cell_(cell), side_(2 * (static_cast<int>(std::ceil(max_range / cell)) + 1)) {
  const CloudGround ground(cloud.points, max_range);
  const bool has_intensities = cloud.intensities.size() == cloud.points.size();
  float largest = 0;
  for (const float intensity : cloud.intensities)
    if (std::isfinite(intensity)) largest = std::max(largest, intensity);
  std::vector<CellPoint> points;
  points.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!(p.head<2>().norm() < static_cast<float>(max_range)) || !std::isfinite(p.z())) continue;
    const double height = static_cast<double>(p.z()) - static_cast<double>(ground.at(p.x(), p.y()));
    if (!(height >= min_height && height <= max_height)) continue;
    const auto [x, y] = column_of(p);
    const auto layer =
        static_cast<std::uint64_t>(std::floor(height / cell) + 1024);  // the lowest may be below 0
    const float strength = has_intensities ? cloud.intensities[i] : 0;
    const double intensity = largest > 0 && strength > 0 ? static_cast<double>(strength / largest) : 0;
    points.push_back(
        {(static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(side_) + static_cast<std::uint64_t>(x)) *
                 65536 +
             layer,
         whole(static_cast<double>(p.x())), whole(static_cast<double>(p.y())),
         whole(static_cast<double>(p.z())), whole(height), whole(intensity)});
  }
  std::ranges::sort(points, {}, &CellPoint::key);
  starts_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
  for (std::size_t first = 0; first < points.size();) {
    CellPoint sum = points[first];
    std::size_t end = first + 1;
    for (; end < points.size() && points[end].key == sum.key; ++end) {
      sum.x += points[end].x, sum.y += points[end].y, sum.z += points[end].z;
      sum.height += points[end].height, sum.intensity += points[end].intensity;
    }
    const double count = kUnit * static_cast<double>(end - first);
    const auto mean = [&](std::int64_t of) { return static_cast<float>(static_cast<double>(of) / count); };
    cells_.push_back({.at = {mean(sum.x), mean(sum.y), mean(sum.z)},
                      .height = mean(sum.height),
                      .intensity = mean(sum.intensity) * largest,
                      .points = static_cast<int>(end - first)});
    ++starts_[sum.key / 65536 + 1];
    first = end;
  }
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
}

}  // namespace waymark::localization

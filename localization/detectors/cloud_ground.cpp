// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waymark::localization {
namespace {

constexpr float kConfirmed = 0.2F;  // m between the lowest points of a cell
constexpr float kNone = std::numeric_limits<float>::infinity();

}  // namespace

CloudGround::CloudGround(std::span<const Eigen::Vector3f> points, double max_range)
    : cells_(2 * static_cast<int>(std::ceil(max_range))), half_(static_cast<float>(cells_) / 2) {
  const auto size = static_cast<std::size_t>(cells_);
  std::vector<float> first(size * size, kNone), second = first;  // the lowest and the next
  for (const Eigen::Vector3f& p : points) {
    const float x = std::floor(p.x() + half_), y = std::floor(p.y() + half_);
    if (!(x >= 0 && x < static_cast<float>(cells_) && y >= 0 && y < static_cast<float>(cells_)) ||
        !std::isfinite(p.z()))
      continue;
    const std::size_t i = static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x);
    if (p.z() < first[i])
      second[i] = std::exchange(first[i], p.z());
    else if (p.z() < second[i])
      second[i] = p.z();
  }
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!(second[i] - first[i] < kConfirmed)) first[i] = second[i];
  heights_.assign(size * size, kNone);
  for (int y = 0; y < cells_; ++y)
    for (int x = 0; x < cells_; ++x)
      for (int v = std::max(0, y - 1); v <= std::min(cells_ - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(cells_ - 1, x + 1); ++u) {
          float& height = heights_[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)];
          height = std::min(height, first[static_cast<std::size_t>(v) * size + static_cast<std::size_t>(u)]);
        }
}

float CloudGround::at(float x, float y) const {
  const float u = std::floor(x + half_), v = std::floor(y + half_);
  if (!(u >= 0 && u < static_cast<float>(cells_) && v >= 0 && v < static_cast<float>(cells_)))
    return std::numeric_limits<float>::quiet_NaN();
  const float height =
      heights_[static_cast<std::size_t>(v) * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(u)];
  return std::isfinite(height) ? height : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace waymark::localization

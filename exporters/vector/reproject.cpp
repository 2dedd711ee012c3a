// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/reproject.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"

namespace waymark::exporters {
namespace {

struct Pair {
  std::size_t x = 0, y = 0;
};

std::vector<Pair> position_pairs(const LandmarkType& type) {
  std::vector<Pair> pairs;
  const auto& all = type.attributes;
  for (std::size_t x = 0; x < all.size(); ++x) {
    if (!all[x].name.ends_with("_x")) continue;
    const std::string twin = all[x].name.substr(0, all[x].name.size() - 1) + "y";
    const auto y =
        std::find_if(all.begin(), all.end(), [&](const AttributeSpec& a) { return a.name == twin; });
    if (y != all.end()) pairs.push_back({x, static_cast<std::size_t>(y - all.begin())});
  }
  return pairs;
}

void reproject(AttributeSet& attributes, const Pair& pair, const CrsTransform& transform) {
  if (std::max(pair.x, pair.y) >= attributes.size()) return;
  const double* x = std::get_if<double>(&attributes[pair.x]);
  const double* y = std::get_if<double>(&attributes[pair.y]);
  if (x == nullptr || y == nullptr) return;
  const auto there = transform(*x, *y);
  const bool found = std::isfinite(there.x) && std::isfinite(there.y);
  attributes[pair.x] = found ? AttributeValue(there.x) : AttributeValue();
  attributes[pair.y] = found ? AttributeValue(there.y) : AttributeValue();
}

}  // namespace

Reprojected reproject(std::vector<Landmark> landmarks, const LandmarkType& type, const Crs& from,
                      const Crs& to) {
  if (from.same_as(to)) return {std::move(landmarks)};
  const CrsTransform transform(from, to);
  const auto pairs = position_pairs(type);
  for (Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    rotate_axes(landmark, type.features, [&] { return axes_rotation(transform, from, to, at.x(), at.y()); });
    const auto there = transform(at.x(), at.y());
    landmark.position.xyz.head<2>() = Eigen::Vector2d(there.x, there.y);
    for (const Pair& pair : pairs) reproject(landmark.attributes, pair, transform);
  }
  const auto lost =
      std::erase_if(landmarks, [](const Landmark& l) { return !l.position.xyz.head<2>().allFinite(); });
  return {std::move(landmarks), static_cast<std::int64_t>(lost)};
}

}  // namespace waymark::exporters

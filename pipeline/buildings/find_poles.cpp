// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/find_poles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>

#include "core/median.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kLowest = 1;   // m: cars, hedges and the ground's errors are lower
constexpr double kLayer = 0.5;  // m
constexpr std::size_t kMinLayers = 3;
constexpr double kMinTall = 1;       // m from the lowest return of a group to its highest
constexpr double kMinPoleSd = 0.05;  // m

/// Groups of points nearer than a distance to each other, on the plane.
class Groups {
 public:
  Groups(const std::vector<SurfacePoint>& points, double distance) : points_(points), parent_(points.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    std::unordered_map<std::int64_t, std::vector<std::size_t>> buckets;
    const auto index = [&](double v) { return static_cast<std::int64_t>(std::floor(v / distance)); };
    const auto key = [](std::int64_t i, std::int64_t j) { return j * (std::int64_t{1} << 32) + i; };
    for (std::size_t p = 0; p < points.size(); ++p) {
      const std::int64_t i = index(points[p].x), j = index(points[p].y);
      for (std::int64_t l = j - 1; l <= j + 1; ++l)
        for (std::int64_t k = i - 1; k <= i + 1; ++k)
          if (const auto bucket = buckets.find(key(k, l)); bucket != buckets.end())
            for (const std::size_t q : bucket->second)
              if (std::hypot(points[p].x - points[q].x, points[p].y - points[q].y) < distance) unite(p, q);
      buckets[key(i, j)].push_back(p);
    }
  }

  /// Returns the members of each group, by the order of their first.
  std::vector<std::vector<std::size_t>> all() {
    std::vector<std::vector<std::size_t>> groups;
    std::unordered_map<std::size_t, std::size_t> number;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const auto [at, is_new] = number.try_emplace(root(p), groups.size());
      if (is_new) groups.emplace_back();
      groups[at->second].push_back(p);
    }
    return groups;
  }

 private:
  std::size_t root(std::size_t p) {
    while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
    return p;
  }
  void unite(std::size_t a, std::size_t b) {
    const std::size_t i = root(a), j = root(b);
    parent_[std::max(i, j)] = std::min(i, j);
  }

  const std::vector<SurfacePoint>& points_;
  std::vector<std::size_t> parent_;
};

}  // namespace

FoundPoles find_poles(const CanopySource& canopy, const Window& owned, const PoleRules& rules) {
  const Georeference& where = canopy.geometry().where;
  const double unit = where.crs.metres_per_unit(), cell_x = where.dx * unit, cell_y = -where.dy * unit;
  // Beyond the group and the clearance; groups that reach the edge of the window are too wide.
  const auto halo = static_cast<std::int64_t>(
                        std::ceil(2 * (rules.max_width + rules.clearance) / std::min(cell_x, cell_y))) +
                    1;
  std::vector<SurfacePoint> points;
  const Window window{owned.column - halo, owned.row - halo, owned.columns + 2 * halo, owned.rows + 2 * halo};
  canopy.visit_surface(window, [&](const SurfacePoint& p) {
    if (static_cast<double>(p.height) >= kLowest) points.push_back(p);
  });
  std::ranges::sort(points, {}, [](const SurfacePoint& p) {
    return std::tuple(p.x, p.y, p.z, p.number, p.of, p.classification);
  });
  FoundPoles found;
  for (const std::vector<std::size_t>& group : Groups(points, rules.clearance).all()) {
    std::vector<double> xs, ys;
    double highest = 0, lowest = std::numeric_limits<double>::infinity(), ground = 0;
    std::set<std::int64_t> layers;
    for (const std::size_t i : group) {
      const SurfacePoint& p = points[i];
      xs.push_back(p.x), ys.push_back(p.y);
      const auto height = static_cast<double>(p.height);
      highest = std::max(highest, height), lowest = std::min(lowest, height);
      layers.insert(static_cast<std::int64_t>(std::floor(height / kLayer)));
      ground += (p.z - height) / static_cast<double>(group.size());
    }
    const double n = static_cast<double>(group.size());
    const double x = std::accumulate(xs.begin(), xs.end(), 0.0) / n,
                 y = std::accumulate(ys.begin(), ys.end(), 0.0) / n;
    const auto column = std::llround(x / cell_x), row = std::llround(-y / cell_y);
    if (!owned.contains(column, row)) continue;
    const auto [left, right] = std::ranges::minmax(xs);
    const auto [low, high] = std::ranges::minmax(ys);
    if (std::hypot(right - left, high - low) > rules.max_width) {
      ++found.rejected["wider than a pole"];
      continue;
    }
    if (highest < rules.min_height || highest > rules.max_height) {
      ++found.rejected["height of no pole"];
      continue;
    }
    if (n < static_cast<double>(rules.min_returns) || layers.size() < kMinLayers ||
        highest - lowest < kMinTall) {
      ++found.rejected["too few returns, one above the other"];
      continue;
    }
    double spread = 0;
    for (const std::size_t i : group)
      spread += (points[i].x - x) * (points[i].x - x) + (points[i].y - y) * (points[i].y - y);
    DetectedPole pole{.at = {x, y}, .height = highest, .ground = ground, .returns = std::ssize(group)};
    pole.sd = std::max(kMinPoleSd, std::sqrt(spread / 2 / (n - 1) / n));
    if (!(canopy.ground(Window{column, row, 1, 1})(0, 0) > -1e9F)) pole.ground = std::nan("");
    pole.confidence = (1 - std::exp(-n / 4)) * (1 - std::exp(-static_cast<double>(layers.size()) / 3));
    found.poles.push_back(pole);
  }
  std::ranges::sort(found.poles, {}, [](const DetectedPole& p) { return std::pair(p.at.x(), p.at.y()); });
  return found;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

namespace waymark::testbed {

std::vector<Obstacle> obstacles_of(std::span<const RockSolid> rocks, double height) {
  std::vector<Obstacle> all;
  for (const RockSolid& rock : rocks)
    if (rock.top > height)
      all.push_back({rock.foot.head<2>(), rock.shape == RockShape::irregular
                                              ? std::min(rock.reach, 1.2 * rock.half_x)
                                              : std::max(rock.half_x, rock.half_y)});
  return all;
}

TraversableMap::TraversableMap(const Terrain& terrain, std::span<const Obstacle> obstacles, double clearance,
                               double margin, double max_slope)
    : x0_(terrain.x0()), y0_(terrain.y0()) {
  const double width = double(terrain.heights().columns() - 1) * terrain.step_x();
  const double depth = double(terrain.heights().rows() - 1) * terrain.step_y();
  free_ = Grid<std::uint8_t>(static_cast<std::int64_t>(width / kSquare),
                             static_cast<std::int64_t>(depth / kSquare), 1);
  for (std::int64_t r = 0; r < free_.rows(); ++r)
    for (std::int64_t c = 0; c < free_.columns(); ++c) {
      const Eigen::Vector2d at = middle({c, r});
      const bool inside = at.x() - x0_ >= margin && x0_ + width - at.x() >= margin &&
                          y0_ - at.y() >= margin && at.y() - (y0_ - depth) >= margin;
      const auto west = terrain.height(at.x() - 1, at.y()), east = terrain.height(at.x() + 1, at.y());
      const auto south = terrain.height(at.x(), at.y() - 1), north = terrain.height(at.x(), at.y() + 1);
      const bool known = west && east && south && north;
      free_(c, r) = inside && known && std::hypot(*east - *west, *north - *south) / 2 <= max_slope ? 1 : 0;
    }
  for (const Obstacle& o : obstacles) {
    const double reach = o.radius + clearance;
    const Cell low = cell(o.at + Eigen::Vector2d(-reach, reach)),
               high = cell(o.at + Eigen::Vector2d(reach, -reach));
    for (std::int64_t r = low.row; r <= high.row; ++r)
      for (std::int64_t c = low.column; c <= high.column; ++c)
        if (free_.contains(c, r) && (middle({c, r}) - o.at).norm() <= reach) free_(c, r) = 0;
  }
}

TraversableMap::Cell TraversableMap::cell(const Eigen::Vector2d& at) const {
  return {static_cast<std::int64_t>(std::floor((at.x() - x0_) / kSquare)),
          static_cast<std::int64_t>(std::floor((y0_ - at.y()) / kSquare))};
}

Eigen::Vector2d TraversableMap::middle(const Cell& cell) const {
  return {x0_ + (double(cell.column) + 0.5) * kSquare, y0_ - (double(cell.row) + 0.5) * kSquare};
}

bool TraversableMap::free(const Eigen::Vector2d& at) const {
  const Cell c = cell(at);
  return free_.contains(c.column, c.row) && free_(c.column, c.row) != 0;
}

std::optional<TraversableMap::Cell> TraversableMap::nearest_free(const Cell& from) const {
  for (std::int64_t ring = 0; ring < 60; ++ring) {
    std::optional<Cell> best;
    std::int64_t min_far = 0;
    for (std::int64_t r = from.row - ring; r <= from.row + ring; ++r)
      for (std::int64_t c = from.column - ring; c <= from.column + ring; ++c) {
        if (std::max(std::abs(r - from.row), std::abs(c - from.column)) != ring) continue;
        if (!free_.contains(c, r) || free_(c, r) == 0) continue;
        const std::int64_t far = (r - from.row) * (r - from.row) + (c - from.column) * (c - from.column);
        if (!best || far < min_far) best = Cell{c, r}, min_far = far;
      }
    if (best) return best;
  }
  return std::nullopt;
}

std::vector<Eigen::Vector2d> TraversableMap::shortest_path(const Eigen::Vector2d& from,
                                                           const Eigen::Vector2d& to) const {
  const auto start = nearest_free(cell(from)), goal = nearest_free(cell(to));
  if (!start || !goal) return {};
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Grid<float> cost(free_.columns(), free_.rows(), kFar);
  Grid<std::int8_t> came(free_.columns(), free_.rows(), -1);
  struct Open {
    float estimate;
    std::int64_t index;  // breaks ties, so that the path is the same on all machines
    bool operator<(const Open& o) const { return std::tie(o.estimate, o.index) < std::tie(estimate, index); }
  };
  const auto left = [&](std::int64_t c, std::int64_t r) {
    return static_cast<float>(std::hypot(double(c - goal->column), double(r - goal->row)));
  };
  constexpr int kStep[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  std::priority_queue<Open> open;
  cost(start->column, start->row) = 0;
  open.push({left(start->column, start->row), start->row * free_.columns() + start->column});
  while (!open.empty()) {
    const Open top = open.top();
    open.pop();
    const std::int64_t c = top.index % free_.columns(), r = top.index / free_.columns();
    if (c == goal->column && r == goal->row) break;
    if (top.estimate > cost(c, r) + left(c, r) + 1e-3F) continue;
    for (int k = 0; k < 8; ++k) {
      const std::int64_t nc = c + kStep[k][0], nr = r + kStep[k][1];
      if (!free_.contains(nc, nr) || free_(nc, nr) == 0) continue;
      const float next = cost(c, r) + (k % 2 == 0 ? 1.0F : 1.41421356F);
      if (!(next < cost(nc, nr))) continue;
      cost(nc, nr) = next;
      came(nc, nr) = static_cast<std::int8_t>(k);
      open.push({next + left(nc, nr), nr * free_.columns() + nc});
    }
  }
  if (cost(goal->column, goal->row) == kFar) return {};
  std::vector<Eigen::Vector2d> cells;
  for (Cell at = *goal;;) {
    cells.push_back(middle(at));
    const int k = came(at.column, at.row);
    if (k < 0) break;
    at = {at.column - kStep[k][0], at.row - kStep[k][1]};
  }
  std::ranges::reverse(cells);
  // String pulling: corners with a line of sight over free squares are joined.
  std::vector<Eigen::Vector2d> corners{cells.front()};
  for (std::size_t i = 0; i + 1 < cells.size();) {
    std::size_t next = i + 1;
    for (std::size_t j = i + 2; j < cells.size() && j < i + 60; ++j) {
      const Eigen::Vector2d step = cells[j] - cells[i];
      const int pieces = static_cast<int>(step.norm() / 0.25) + 1;
      bool seen = true;
      for (int k = 1; k < pieces && seen; ++k) seen = free(cells[i] + step * (double(k) / pieces));
      if (seen) next = j;
    }
    corners.push_back(cells[next]);
    i = next;
  }
  return corners;
}

std::vector<Eigen::Vector2d> smooth_path(std::vector<Eigen::Vector2d> corners, double spacing) {
  for (int round = 0; round < 3 && corners.size() > 2; ++round) {
    std::vector<Eigen::Vector2d> cut{corners.front()};
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      cut.push_back(0.75 * corners[i] + 0.25 * corners[i + 1]);
      cut.push_back(0.25 * corners[i] + 0.75 * corners[i + 1]);
    }
    cut.push_back(corners.back());
    corners = std::move(cut);
  }
  std::vector<Eigen::Vector2d> path;
  double left = 0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d step = corners[i + 1] - corners[i];
    const double length = step.norm();
    for (; left < length; left += spacing) path.push_back(corners[i] + step * (left / length));
    left -= length;
  }
  if (!corners.empty()) path.push_back(corners.back());
  return path;
}

std::vector<Eigen::Vector2d> automatic_route(const std::string& kind, const Eigen::Vector2d& middle,
                                             const Eigen::Vector2d& half_size, double length,
                                             double lane_spacing, Random& random) {
  std::vector<Eigen::Vector2d> corners;
  double driven = 0;
  const auto go = [&](const Eigen::Vector2d& at) {
    if (!corners.empty()) driven += (at - corners.back()).norm();
    corners.push_back(at);
  };
  if (kind == "lanes") {
    const int lanes = std::max(1, static_cast<int>(2 * half_size.x() / lane_spacing));
    for (int i = 0; driven < length; ++i) {
      // Covers the whole area, then returns between the previous lanes.
      const int pass = i / (lanes + 1), lane = pass % 2 == 0 ? i % (lanes + 1) : lanes - i % (lanes + 1);
      const double x = -half_size.x() + 2 * half_size.x() * (lane + (pass % 2) * 0.5) / (lanes + 0.5);
      const double y = i % 2 == 0 ? -half_size.y() : half_size.y();
      go(middle + Eigen::Vector2d(x, y));
      go(middle + Eigen::Vector2d(x, -y));
    }
  } else if (kind == "loop") {
    const double from = random.uniform(0, 2 * std::numbers::pi);
    for (int i = 0; driven < length; ++i) {
      const double a = from + i * 0.25, part = random.uniform(0.75, 1);
      go(middle + part * Eigen::Vector2d(half_size.x() * std::cos(a), half_size.y() * std::sin(a)));
    }
  } else {
    while (driven < length)
      go(middle +
         Eigen::Vector2d(half_size.x() * random.uniform(-1, 1), half_size.y() * random.uniform(-1, 1)));
  }
  return corners;
}

}  // namespace waymark::testbed

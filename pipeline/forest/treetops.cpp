// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/treetops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipeline/forest/local_maxima.hpp"

namespace waymark::pipeline {
namespace {

struct Offset {
  int column, row;
  double distance;  // metres
};

// All cells within `radius`, nearest first.
std::vector<Offset> disc(double radius, double width, double height) {
  std::vector<Offset> offsets;
  const int across = static_cast<int>(radius / width), down = static_cast<int>(radius / height);
  for (int r = -down; r <= down; ++r)
    for (int c = -across; c <= across; ++c) {
      const double distance = std::hypot(c * width, r * height);
      if (distance <= radius && (c || r)) offsets.push_back({c, r, distance});
    }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Offset& a, const Offset& b) { return a.distance < b.distance; });
  return offsets;
}

class TopTest {
 public:
  explicit TopTest(const CanopyWindow& smooth)
      : smooth_(smooth), grid_(smooth.heights), seen_(grid_.columns(), grid_.rows(), 0) {}

  bool is_isolated(std::int64_t column, std::int64_t row, double radius) {
    if (radius > radius_) offsets_ = disc(radius_ = 1.5 * radius, smooth_.cell_width, smooth_.cell_height);
    const float height = grid_(column, row);
    for (const Offset& o : offsets_) {
      if (o.distance > radius) break;
      const std::int64_t c = column + o.column, r = row + o.row;
      if (!grid_.contains(c, r)) continue;
      const float other = grid_(c, r);
      if (other > height || (other == height && (o.row < 0 || (o.row == 0 && o.column < 0)))) return false;
    }
    return true;
  }

  // Floods cells less than `prominence` below the top until a higher cell is reached.
  bool is_prominent(std::int64_t column, std::int64_t row, double prominence) {
    const float height = grid_(column, row);
    const auto floor = static_cast<float>(height - prominence);
    ++stamp_;
    flood_.assign(1, {column, row});
    seen_(column, row) = stamp_;
    for (std::size_t i = 0; i < flood_.size(); ++i)
      for (const auto& [dc, dr] : kNeighbours) {
        const std::int64_t c = flood_[i].column + dc, r = flood_[i].row + dr;
        if (!grid_.contains(c, r) || seen_(c, r) == stamp_) continue;
        seen_(c, r) = stamp_;
        const float other = grid_(c, r);
        if (!(other > floor) || !is_near(c - column, r - row)) continue;
        if (other > height || (other == height && (r < row || (r == row && c < column)))) return false;
        flood_.push_back({c, r});
      }
    return true;
  }

 private:
  bool is_near(std::int64_t columns, std::int64_t rows) const {
    const double x = static_cast<double>(columns) * smooth_.cell_width;
    const double y = static_cast<double>(rows) * smooth_.cell_height;
    return x * x + y * y <= kProminenceReach * kProminenceReach;
  }

  const CanopyWindow& smooth_;
  const Grid<float>& grid_;
  Grid<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
  std::vector<CanopyCell> flood_;
  std::vector<Offset> offsets_;
  double radius_ = 0;
};

}  // namespace

std::int64_t treetop_reach(const TreetopRules& rules, double cell) {
  const double metres =
      std::max(rules.isolation(kMaxTreeHeight), rules.prominence > 0 ? kProminenceReach : 0.0);
  return static_cast<std::int64_t>(std::ceil(metres / cell)) + 1;
}

std::vector<Treetop> find_treetops(const CanopyWindow& smooth, const Window& owned, const RulesAt& rules) {
  TopTest test(smooth);
  std::vector<Treetop> tops;
  std::vector<std::uint8_t> is_maximum(static_cast<std::size_t>(owned.columns));
  const std::int64_t first = owned.column - smooth.cells.column;
  for (std::int64_t row = owned.row; row < owned.end_row(); ++row) {
    const std::int64_t r = row - smooth.cells.row;
    local_maxima(smooth.heights, first, r, is_maximum);
    for (std::size_t i = 0; i < is_maximum.size(); ++i) {
      if (!is_maximum[i]) continue;
      const std::int64_t c = first + static_cast<std::int64_t>(i);
      const CanopyCell cell{c + smooth.cells.column, row};
      const float height = smooth.heights(c, r);
      const TreetopRules& rule = rules(cell);
      if (!(height >= rule.min_height)) continue;
      if (!test.is_isolated(c, r, rule.isolation(height))) continue;
      if (rule.prominence > 0 && !test.is_prominent(c, r, rule.prominence)) continue;
      tops.push_back({cell, height});
    }
  }
  return tops;
}

}  // namespace waymark::pipeline

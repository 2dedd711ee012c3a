// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/rocks/shadow_map.hpp"
namespace waymark::pipeline {
namespace {

// Dark pixels of a map, numbered in row order.
struct DarkPixels {
  std::vector<std::int32_t> cells;  // row * columns + column
  Grid<std::int32_t> number;        // of each pixel; -1: bright
};

DarkPixels dark_pixels(const Grid<float>& smooth, float grow) {
  DarkPixels dark{{}, Grid<std::int32_t>(smooth.columns(), smooth.rows(), -1)};
  const auto values = smooth.cells();
  const auto numbers = dark.number.cells();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > grow) {
      numbers[i] = static_cast<std::int32_t>(dark.cells.size());
      dark.cells.push_back(static_cast<std::int32_t>(i));
    }
  return dark;
}

std::int32_t root(std::vector<std::int32_t>& parent, std::int32_t i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    auto& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

struct Pass {
  float height;       // of the saddle between two dark spots
  std::int32_t a, b;  // their pixels
};

template <class Visit>
void for_neighbours(const DarkPixels& dark, std::int32_t cell, Visit visit) {
  const auto columns = static_cast<std::int32_t>(dark.number.columns());
  const std::int32_t x = cell % columns, y = cell / columns;
  if (x > 0 && y > 0 && x + 1 < columns && y + 1 < dark.number.rows()) {
    const std::int32_t* here = &dark.number.cells()[static_cast<std::size_t>(cell)];
    for (const std::int32_t* row : {here - columns, here, here + columns})
      for (std::int32_t dx = -1; dx <= 1; ++dx)
        if (row[dx] >= 0 && row + dx != here) visit(row[dx]);
    return;
  }
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || !dark.number.contains(x + dx, y + dy)) continue;
      const std::int32_t other = dark.number(x + dx, y + dy);
      if (other >= 0) visit(other);
    }
}

constexpr float kMiddle = 0.6F;  // fraction of the peak above which lies the dark core of a shadow
constexpr std::int64_t kNear = 2, kFar = 4;  // pixels: ring of ground around it

// Shading of slopes finer than the background tiles affects a shadow and the ground beside it alike.
float base_of(const Grid<float>& smooth, const std::vector<std::int32_t>& middle, float peak) {
  const std::int64_t columns = smooth.columns();
  std::int64_t x0 = columns, x1 = 0, y0 = smooth.rows(), y1 = 0;
  for (const std::int32_t cell : middle) {
    x0 = std::min<std::int64_t>(x0, cell % columns);
    x1 = std::max<std::int64_t>(x1, cell % columns);
    y0 = std::min<std::int64_t>(y0, cell / columns);
    y1 = std::max<std::int64_t>(y1, cell / columns);
  }
  Grid<char> near(x1 - x0 + 1 + 2 * kFar, y1 - y0 + 1 + 2 * kFar, 0);  // 2: within kNear, 1: within kFar
  for (const std::int32_t cell : middle) {
    const std::int64_t u = cell % columns - x0 + kFar, v = cell / columns - y0 + kFar;
    for (std::int64_t dv = -kFar; dv <= kFar; ++dv)
      for (std::int64_t du = -kFar; du <= kFar; ++du) {
        const char mark = std::max(std::abs(du), std::abs(dv)) <= kNear ? 2 : 1;
        near(u + du, v + dv) = std::max(near(u + du, v + dv), mark);
      }
  }
  std::vector<float> beside;
  for (std::int64_t v = 0; v < near.rows(); ++v)
    for (std::int64_t u = 0; u < near.columns(); ++u)
      if (near(u, v) == 1 && smooth.contains(u + x0 - kFar, v + y0 - kFar))
        beside.push_back(smooth(u + x0 - kFar, v + y0 - kFar));
  if (beside.empty()) return 0;
  const auto half = beside.begin() + static_cast<std::ptrdiff_t>(beside.size() / 2);
  std::nth_element(beside.begin(), half, beside.end());
  return std::clamp(*half, -0.3F, 0.6F * peak);
}

}  // namespace

std::vector<ShadowSegment> find_segments(const ShadowMap& map, const SegmentLimits& limits) {
  const DarkPixels dark = dark_pixels(map.smooth, limits.grow);
  const auto values = map.smooth.cells();
  const auto value = [&](std::int32_t i) {
    return values[static_cast<std::size_t>(dark.cells[static_cast<std::size_t>(i)])];
  };
  // Ties are ordered by number, so that plateaus have one top and ascent cannot cycle.
  const auto higher = [&](std::int32_t a, std::int32_t b) {
    return value(a) != value(b) ? value(a) > value(b) : a < b;
  };
  const auto count = static_cast<std::int32_t>(dark.cells.size());
  std::vector<std::int32_t> parent(dark.cells.size());
  for (std::int32_t i = 0; i < count; ++i) {
    std::int32_t best = i;
    for_neighbours(dark, dark.cells[static_cast<std::size_t>(i)],
                   [&](std::int32_t j) { best = higher(j, best) ? j : best; });
    parent[static_cast<std::size_t>(i)] = best;
  }
  std::vector<std::int32_t> top(dark.cells.size());
  for (std::int32_t i = 0; i < count; ++i) top[static_cast<std::size_t>(i)] = root(parent, i);
  std::vector<Pass> passes;
  for (std::int32_t i = 0; i < count; ++i)
    for_neighbours(dark, dark.cells[static_cast<std::size_t>(i)], [&](std::int32_t j) {
      const auto a = top[static_cast<std::size_t>(i)], b = top[static_cast<std::size_t>(j)];
      if (j > i && a != b) passes.push_back({std::min(value(i), value(j)), std::min(a, b), std::max(a, b)});
    });
  std::sort(passes.begin(), passes.end(), [](const Pass& p, const Pass& q) {
    return p.height != q.height ? p.height > q.height : p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  for (const Pass& pass : passes) {
    const auto a = root(parent, pass.a), b = root(parent, pass.b);
    if (a == b) continue;
    const auto [high, low] = higher(a, b) ? std::pair{a, b} : std::pair{b, a};
    if (pass.height > limits.merge * value(low)) parent[static_cast<std::size_t>(low)] = high;
  }
  std::vector<std::size_t> catchment(dark.cells.size(), 0);
  for (std::int32_t i = 0; i < count; ++i) ++catchment[static_cast<std::size_t>(root(parent, i))];
  const auto columns = static_cast<std::int32_t>(map.smooth.columns());
  std::vector<std::int32_t> visit(dark.cells.size(), -1);  // stamp of the last flood that reached a pixel
  std::int32_t stamp = 0;
  const auto flood = [&](std::int32_t summit, float min_value) {
    std::vector<std::int32_t> open{summit}, cells;
    visit[static_cast<std::size_t>(summit)] = ++stamp;
    for (std::size_t k = 0; k < open.size(); ++k) {
      cells.push_back(dark.cells[static_cast<std::size_t>(open[k])]);
      for_neighbours(dark, cells.back(), [&](std::int32_t j) {
        auto& seen = visit[static_cast<std::size_t>(j)];
        if (seen == stamp || !(value(j) > min_value) || root(parent, j) != summit) return;
        seen = stamp;
        open.push_back(j);
      });
    }
    std::sort(cells.begin(), cells.end());
    return cells;
  };
  std::vector<ShadowSegment> segments;
  for (std::int32_t summit = 0; summit < count; ++summit) {
    if (parent[static_cast<std::size_t>(summit)] != summit || value(summit) <= limits.seed) continue;
    const std::int32_t cell = dark.cells[static_cast<std::size_t>(summit)];
    ShadowSegment segment{.x = cell % columns, .y = cell / columns, .peak = value(summit), .cells = {}};
    segment.catchment_cells = catchment[static_cast<std::size_t>(summit)];
    const auto middle = flood(summit, kMiddle * segment.peak);
    if (limits.max_cells > 0 && middle.size() > limits.max_cells) continue;
    segment.base = base_of(map.smooth, middle, segment.peak);
    if (!(segment.peak - segment.base > limits.seed)) continue;
    segment.cells = flood(summit, segment.base + limits.core * (segment.peak - segment.base));
    segments.push_back(std::move(segment));
  }
  if (limits.max_cells > 0)
    std::erase_if(segments, [&](const ShadowSegment& s) { return s.cells.size() > limits.max_cells; });
  std::sort(segments.begin(), segments.end(), [](const ShadowSegment& a, const ShadowSegment& b) {
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return segments;
}

}  // namespace waymark::pipeline

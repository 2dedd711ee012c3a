// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <numeric>

#include "pipeline/rocks/shadow_map.hpp"
namespace waymark {
namespace {

// The dark pixels of a map, numbered in reading order.
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
  float height;       // of the saddle between two darks
  std::int32_t a, b;  // their pixels
};

template <class Visit>
void for_neighbours(const DarkPixels& dark, std::int32_t cell, Visit visit) {
  const auto columns = static_cast<std::int32_t>(dark.number.columns());
  const std::int32_t x = cell % columns, y = cell / columns;
  for (std::int32_t dy = -1; dy <= 1; ++dy)
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || !dark.number.contains(x + dx, y + dy)) continue;
      const std::int32_t other = dark.number(x + dx, y + dy);
      if (other >= 0) visit(other);
    }
}

}  // namespace

std::vector<ShadowSegment> find_segments(const ShadowMap& map, const SegmentLimits& limits) {
  const DarkPixels dark = dark_pixels(map.smooth, limits.grow);
  const auto values = map.smooth.cells();
  const auto value = [&](std::int32_t i) {
    return values[static_cast<std::size_t>(dark.cells[static_cast<std::size_t>(i)])];
  };
  // Equal heights are ordered by number, so that plateaus have one top and nothing goes round in circles.
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
  std::vector<std::int32_t> segment_of(dark.cells.size(), -1);
  std::vector<ShadowSegment> segments;
  for (std::int32_t i = 0; i < count; ++i) {
    const auto summit = static_cast<std::size_t>(root(parent, i));
    if (value(static_cast<std::int32_t>(summit)) <= limits.seed) continue;
    if (segment_of[summit] < 0) {
      segment_of[summit] = static_cast<std::int32_t>(segments.size());
      const auto columns = static_cast<std::int32_t>(map.smooth.columns());
      segments.push_back({.x = dark.cells[summit] % columns,
                          .y = dark.cells[summit] / columns,
                          .peak = value(static_cast<std::int32_t>(summit)),
                          .cells = {}});
    }
    segments[static_cast<std::size_t>(segment_of[summit])].cells.push_back(
        dark.cells[static_cast<std::size_t>(i)]);
  }
  if (limits.most_cells > 0)
    std::erase_if(segments, [&](const ShadowSegment& s) { return s.cells.size() > limits.most_cells; });
  std::sort(segments.begin(), segments.end(), [](const ShadowSegment& a, const ShadowSegment& b) {
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return segments;
}

}  // namespace waymark

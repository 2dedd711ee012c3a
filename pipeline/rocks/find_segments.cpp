// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/rocks/shadow_map.hpp"
namespace waymark::pipeline {
namespace {

// Dark neighbours of a dark pixel. Those of the row above have consecutive numbers from `above` on.
struct Neighbours {
  std::int32_t above = 0, below = 0;
  std::int8_t above_count = 0, below_count = 0;
  bool left = false, right = false;
};

// Dark pixels of a map, numbered in row order. Nothing is kept of the others, which are most of an image.
struct DarkPixels {
  std::vector<std::int32_t> cells;  // row * columns + column
  std::vector<float> values;
  std::vector<Neighbours> neighbours;
};

// Links pixels [first, middle) of a row with those of the next one, [middle, end).
void link_rows(DarkPixels& dark, std::int32_t first, std::int32_t middle, std::int32_t end,
               std::int32_t columns) {
  const auto cell = [&](std::int32_t i) { return dark.cells[static_cast<std::size_t>(i)]; };
  std::int32_t from = first;
  for (std::int32_t i = middle; i < end; ++i) {
    const std::int32_t straight = cell(i) - columns;
    while (from < middle && cell(from) < straight - 1) ++from;
    Neighbours& here = dark.neighbours[static_cast<std::size_t>(i)];
    here.above = from;
    for (std::int32_t j = from; j < middle && cell(j) <= straight + 1; ++j) {
      ++here.above_count;
      Neighbours& there = dark.neighbours[static_cast<std::size_t>(j)];
      if (there.below_count == 0) there.below = i;
      ++there.below_count;
    }
  }
}

DarkPixels dark_pixels(const Grid<float>& smooth, float grow) {
  DarkPixels dark;
  const auto columns = static_cast<std::int32_t>(smooth.columns());
  std::int32_t above = 0;  // first of the row above
  for (std::int64_t y = 0; y < smooth.rows(); ++y) {
    const auto first = static_cast<std::int32_t>(dark.cells.size());
    const auto row = smooth.row(y);
    for (std::int32_t x = 0; x < columns; ++x) {
      const float value = row[static_cast<std::size_t>(x)];
      if (!(value > grow)) continue;
      const auto cell = static_cast<std::int32_t>(y) * columns + x;
      const bool left = static_cast<std::int32_t>(dark.cells.size()) > first && dark.cells.back() == cell - 1;
      if (left) dark.neighbours.back().right = true;
      dark.cells.push_back(cell);
      dark.values.push_back(value);
      dark.neighbours.push_back({.left = left});
    }
    link_rows(dark, above, first, static_cast<std::int32_t>(dark.cells.size()), columns);
    above = first;
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
void for_neighbours(const DarkPixels& dark, std::int32_t i, Visit visit) {
  const Neighbours& here = dark.neighbours[static_cast<std::size_t>(i)];
  for (std::int32_t j = here.above; j < here.above + here.above_count; ++j) visit(j);
  if (here.left) visit(i - 1);
  if (here.right) visit(i + 1);
  for (std::int32_t j = here.below; j < here.below + here.below_count; ++j) visit(j);
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
  for (const auto& [distance, mark] : {std::pair{kFar, char{1}}, std::pair{kNear, char{2}}})
    for (std::size_t k = 0; k < middle.size();) {
      std::size_t end = k + 1;  // of a run of cells in one row
      while (end < middle.size() && middle[end] == middle[end - 1] + 1 && middle[end] % columns != 0) ++end;
      const std::int64_t u = middle[k] % columns - x0 + kFar, v = middle[k] / columns - y0 + kFar;
      for (std::int64_t dv = -distance; dv <= distance; ++dv)
        std::fill_n(&near(u - distance, v + dv), static_cast<std::int64_t>(end - k) + 2 * distance, mark);
      k = end;
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
  const auto value = [&](std::int32_t i) { return dark.values[static_cast<std::size_t>(i)]; };
  // Ties are ordered by number, so that plateaus have one top and ascent cannot cycle.
  const auto higher = [&](std::int32_t a, std::int32_t b) {
    return value(a) != value(b) ? value(a) > value(b) : a < b;
  };
  const auto count = static_cast<std::int32_t>(dark.cells.size());
  std::vector<std::int32_t> parent(dark.cells.size());
  for (std::int32_t i = 0; i < count; ++i) {
    std::int32_t best = i;
    for_neighbours(dark, i, [&](std::int32_t j) { best = higher(j, best) ? j : best; });
    parent[static_cast<std::size_t>(i)] = best;
  }
  const auto shorten = [&] {  // every pixel gets its root as parent
    for (std::int32_t i = 0; i < count; ++i) parent[static_cast<std::size_t>(i)] = root(parent, i);
  };
  shorten();
  std::vector<Pass> passes;
  for (std::int32_t i = 0; i < count; ++i)
    for_neighbours(dark, i, [&](std::int32_t j) {
      const auto a = parent[static_cast<std::size_t>(i)], b = parent[static_cast<std::size_t>(j)];
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
  shorten();
  std::vector<std::int32_t> catchment(dark.cells.size(), 0);
  for (const std::int32_t summit : parent) ++catchment[static_cast<std::size_t>(summit)];
  const auto columns = static_cast<std::int32_t>(map.smooth.columns());
  std::vector<std::int32_t> visit(dark.cells.size(), -1);  // stamp of the last flood that reached a pixel
  std::int32_t stamp = 0;
  std::vector<std::int32_t> open;
  const auto flood = [&](std::int32_t summit, float min_value) {
    open.assign(1, summit);
    visit[static_cast<std::size_t>(summit)] = ++stamp;
    for (std::size_t k = 0; k < open.size(); ++k)
      for_neighbours(dark, open[k], [&](std::int32_t j) {
        auto& seen = visit[static_cast<std::size_t>(j)];
        if (seen == stamp || !(value(j) > min_value) || parent[static_cast<std::size_t>(j)] != summit) return;
        seen = stamp;
        open.push_back(j);
      });
    std::sort(open.begin(), open.end());
    std::vector<std::int32_t> cells;
    cells.reserve(open.size());
    for (const std::int32_t i : open) cells.push_back(dark.cells[static_cast<std::size_t>(i)]);
    return cells;
  };
  std::vector<ShadowSegment> segments;
  for (std::int32_t summit = 0; summit < count; ++summit) {
    if (parent[static_cast<std::size_t>(summit)] != summit || value(summit) <= limits.seed) continue;
    const std::int32_t cell = dark.cells[static_cast<std::size_t>(summit)];
    ShadowSegment segment{.x = cell % columns, .y = cell / columns, .peak = value(summit), .cells = {}};
    segment.catchment_cells = static_cast<std::size_t>(catchment[static_cast<std::size_t>(summit)]);
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

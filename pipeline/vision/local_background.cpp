// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/local_background.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>
namespace waymark::pipeline {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kSigmaPerMad = 1.4826F;  // of a normal distribution

// Returns the element that sorting would put at `rank`; reorders. Partitions without branches on the values,
// which are as good as random. Quadratic at worst, so for few values only.
float select(std::span<float> values, std::size_t rank) {
  while (values.size() > 8) {
    const float a = values.front(), b = values[values.size() / 2], c = values.back();
    const float pivot = std::max(std::min(a, b), std::min(std::max(a, b), c));
    std::size_t below = 0, same = 0;
    for (float& value : values) {
      const float moved = value;
      value = values[below];
      values[below] = moved;
      below += moved < pivot;
    }
    if (rank < below) {
      values = values.first(below);
      continue;
    }
    values = values.subspan(below);
    rank -= below;
    for (float& value : values) {
      const float moved = value;
      value = values[same];
      values[same] = moved;
      same += moved == pivot;
    }
    if (rank < same) return pivot;
    values = values.subspan(same);
    rank -= same;
  }
  std::sort(values.begin(), values.end());
  return values[rank];
}

float median_in_place(std::vector<float>& values) {
  constexpr std::size_t kFew = 1024;
  if (values.size() <= kFew) return select(values, values.size() / 2);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void read_samples(const Pixels& image, const Window& window, std::int64_t stride, std::vector<float>& out) {
  out.clear();
  const auto end_row = std::min(window.end_row(), image.rows());
  const auto end_column = std::min(window.end_column(), image.columns());
  for (auto y = std::max<std::int64_t>(0, window.row); y < end_row; y += stride) {
    const auto row = image.row(y);
    for (auto x = std::max<std::int64_t>(0, window.column); x < end_column; x += stride) {
      const float value = row[static_cast<std::size_t>(x)];
      if (std::isfinite(value)) out.push_back(value);
    }
  }
}

// Tiles without data take the mean of their known neighbours, ring by ring.
void fill_unknown(Grid<float>& level, Grid<float>& spread) {
  for (bool changed = true; changed;) {
    changed = false;
    const Grid<float> before = level, spread_before = spread;
    for (std::int64_t r = 0; r < level.rows(); ++r)
      for (std::int64_t c = 0; c < level.columns(); ++c) {
        if (std::isfinite(before(c, r))) continue;
        float sum = 0, spread_sum = 0, count = 0;
        for (std::int64_t dr = -1; dr <= 1; ++dr)
          for (std::int64_t dc = -1; dc <= 1; ++dc)
            if (before.contains(c + dc, r + dr) && std::isfinite(before(c + dc, r + dr))) {
              sum += before(c + dc, r + dr);
              spread_sum += spread_before(c + dc, r + dr);
              ++count;
            }
        if (count == 0) continue;
        level(c, r) = sum / count;
        spread(c, r) = spread_sum / count;
        changed = true;
      }
  }
}

void find_runs(LocalBackground& ground) {
  const float half = 0.5F * static_cast<float>(ground.tile - 1), step = static_cast<float>(ground.tile);
  const auto last = static_cast<float>(ground.level.columns() - 1);
  for (std::int64_t x = 0; x < ground.columns; ++x) {
    const float place = std::clamp((static_cast<float>(x) - half) / step, 0.0F, last);
    const auto left = static_cast<std::int64_t>(place);
    if (ground.runs.empty() || ground.runs.back().tile != left) ground.runs.push_back({left, x, x});
    ground.runs.back().end = x + 1;
    ground.fraction.push_back(place - static_cast<float>(left));
  }
}

// Four values of a grid between whose centres a run of a row lies.
struct Corners {
  float a, b, c, d;
  float fv;  // position between the rows of centres, [0, 1]

  float blend(float fu) const { return (1 - fv) * ((1 - fu) * a + fu * b) + fv * ((1 - fu) * c + fu * d); }
};

Corners corners_of(const LocalBackground& ground, const Grid<float>& grid, std::int64_t tile,
                   std::int64_t row) {
  const float half = 0.5F * static_cast<float>(ground.tile - 1), step = static_cast<float>(ground.tile);
  const float v =
      std::clamp((static_cast<float>(row) - half) / step, 0.0F, static_cast<float>(grid.rows() - 1));
  const auto r0 = static_cast<std::int64_t>(v);
  const auto r1 = std::min(r0 + 1, grid.rows() - 1), c1 = std::min(tile + 1, grid.columns() - 1);
  return {grid(tile, r0), grid(c1, r0), grid(tile, r1), grid(c1, r1), v - static_cast<float>(r0)};
}

}  // namespace

LocalBackground local_background(const Pixels& image, int tile) {
  LocalBackground ground;
  ground.tile = tile;
  ground.columns = image.columns();
  ground.rows = image.rows();
  if (image.columns() == 0 || image.rows() == 0) return ground;
  const std::int64_t columns = (image.columns() + tile - 1) / tile, rows = (image.rows() + tile - 1) / tile;
  ground.level = Grid<float>(columns, rows, kNan);
  ground.spread = Grid<float>(columns, rows, kNan);
  std::vector<float> samples;
  const std::int64_t stride = std::max(1, tile / 8);
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c) {
      const Window around{c * tile - tile / 2, r * tile - tile / 2, 2 * tile, 2 * tile};
      read_samples(image, around, stride, samples);
      if (samples.size() < 8) continue;  // too few for a median to mean anything
      const float level = median_in_place(samples);
      for (float& value : samples) value = std::abs(value - level);
      ground.level(c, r) = level;
      ground.spread(c, r) = kSigmaPerMad * median_in_place(samples);
    }
  fill_unknown(ground.level, ground.spread);
  find_runs(ground);
  return ground;
}

void LocalBackground::read_row(std::int64_t row, std::span<float> level_out,
                               std::span<float> spread_out) const {
  const auto read = [&](const Grid<float>& grid, std::span<float> out) {
    for (const Run& run : runs) {
      const Corners corners = corners_of(*this, grid, run.tile, row);
      const float* const from = fraction.data();
      float* const to = out.data();
      for (std::int64_t x = run.begin; x < run.end; ++x) to[x] = corners.blend(from[x]);
    }
  };
  read(level, level_out);
  if (!spread_out.empty()) read(spread, spread_out);
}

float LocalBackground::spread_at(std::int64_t column, std::int64_t row) const {
  const auto run = std::ranges::upper_bound(runs, column, {}, &Run::end);
  return corners_of(*this, spread, run->tile, row).blend(fraction[static_cast<std::size_t>(column)]);
}

float noise_sd(const Pixels& image) {
  if (image.columns() < 3 || image.rows() < 3) return 0;
  // At most about 40000 positions, evenly spread; odd strides avoid aliasing with regular patterns.
  const double places = static_cast<double>((image.columns() - 2) * (image.rows() - 2));
  const auto stride = static_cast<std::int64_t>(std::sqrt(places / 40000.0)) | 1;
  std::vector<float> sizes;
  for (std::int64_t y = 1; y + 1 < image.rows(); y += stride)
    for (std::int64_t x = 1; x + 1 < image.columns(); x += stride) {
      const float corners =
          image(x - 1, y - 1) + image(x + 1, y - 1) + image(x - 1, y + 1) + image(x + 1, y + 1);
      const float sides = image(x, y - 1) + image(x - 1, y) + image(x + 1, y) + image(x, y + 1);
      const float second = corners - 2 * sides + 4 * image(x, y);
      if (std::isfinite(second)) sizes.push_back(std::abs(second));
    }
  if (sizes.empty()) return 0;
  return kSigmaPerMad * median_in_place(sizes) / 6;  // the mask's weights: sqrt(4 + 4 * 4 + 16) = 6
}

}  // namespace waymark::pipeline

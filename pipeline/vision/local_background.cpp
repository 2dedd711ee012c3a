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

float median_in_place(std::vector<float>& values) {
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
  return ground;
}

void LocalBackground::read_row(std::int64_t row, std::span<float> level_out,
                               std::span<float> spread_out) const {
  const float half = 0.5F * static_cast<float>(tile - 1), step = static_cast<float>(tile);
  const float v =
      std::clamp((static_cast<float>(row) - half) / step, 0.0F, static_cast<float>(level.rows() - 1));
  const auto r0 = static_cast<std::int64_t>(v);
  const auto r1 = std::min(r0 + 1, level.rows() - 1);
  const float fv = v - static_cast<float>(r0);
  const auto last = static_cast<float>(level.columns() - 1);
  const auto place = [&](std::int64_t x) {
    return std::clamp((static_cast<float>(x) - half) / step, 0.0F, last);
  };
  constexpr std::int64_t kAtOnce = 8;
  // Processes runs of pixels between the same two tile centres, several at a time, so that they vectorise.
  for (std::int64_t x = 0; x < columns;) {
    const auto c0 = static_cast<std::int64_t>(place(x));
    const auto c1 = std::min(c0 + 1, level.columns() - 1);
    std::int64_t end = std::min(columns, x + 1);
    while (end < columns && static_cast<std::int64_t>(place(end)) == c0) ++end;
    const auto mix = [&](const Grid<float>& g, std::span<float> out) {
      const float a = g(c0, r0), b = g(c1, r0), c = g(c0, r1), d = g(c1, r1);
      const auto from = static_cast<float>(c0);
      float* to = out.data();
      const auto blend = [=](float fu) {
        return (1 - fv) * ((1 - fu) * a + fu * b) + fv * ((1 - fu) * c + fu * d);
      };
      std::int64_t k = x;
      for (; k + kAtOnce <= end; k += kAtOnce) {
        float at[kAtOnce];
        for (std::int64_t i = 0; i < kAtOnce; ++i)
          at[i] = std::min(std::max((static_cast<float>(k + i) - half) / step, 0.0F), last) - from;
        for (std::int64_t i = 0; i < kAtOnce; ++i) to[k + i] = blend(at[i]);
      }
      for (; k < end; ++k) to[k] = blend(place(k) - from);
    };
    mix(level, level_out);
    if (!spread_out.empty()) mix(spread, spread_out);
    x = end;
  }
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

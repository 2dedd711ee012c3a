// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/shadow_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/vision/local_background.hpp"
namespace waymark::pipeline {
namespace {

constexpr float kDarkest = 1.3F, kBrightest = -1.5F;   // values beyond are noise
constexpr float kSide = 1.0F / 6, kCentre = 4.0F / 6;  // weak enough to keep adjacent small rocks apart
constexpr float kBrightestSmoothed = -0.2F;  // keeps a lit face from hiding the small shadow beside it

float median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

constexpr float kShaded = 0.25F;  // of the depth of lit ground: what is darker lies in shadow itself

constexpr float kFlat = 0.85F;              // depth of the four neighbours / depth of the floor
constexpr float kDeeperThanPointed = 1.3F;  // depth of full shadow / depth of the deepest pointed floors

// Returns the 0.2 % quantile, for terrain whose own light and shadow hide single spots. White noise alone
// reaches 2.9 standard deviations there, which the caller treats as no contrast.
std::optional<float> low_quantile(const Pixels& image) {
  std::vector<float> values;
  const std::size_t stride = 1 + image.cells().size() / 100000;
  for (std::size_t i = 0; i < image.cells().size(); i += stride)
    if (std::isfinite(image.cells()[i])) values.push_back(image.cells()[i]);
  if (values.empty()) return std::nullopt;
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 500);
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

struct Floor {
  float value = 0, level = 0;  // of the floor and of the surrounding ground
};

// Estimates the brightness of full shadow as a low quantile of all floors: those of deep shadows accumulate
// there, those of small shadows, brightened by blur, lie above. A floor is a pixel no brighter than its eight
// neighbours and well below the ground.
std::optional<float> umbra_of(const Pixels& image, const LocalBackground& ground, float noise) {
  const auto columns = image.columns();
  std::vector<float> level(static_cast<std::size_t>(columns));
  std::vector<Floor> floors, flat;
  for (std::int64_t y = 1; y + 1 < image.rows(); ++y) {
    ground.read_row(y, level, {});
    const auto above = image.row(y - 1), here = image.row(y), below = image.row(y + 1);
    for (std::size_t x = 1; x + 1 < level.size(); ++x) {
      const float value = here[x];
      if (!(value < level[x] - 4 * noise)) continue;
      const float sides = std::min(std::min(here[x - 1], here[x + 1]), std::min(above[x], below[x]));
      const float corners =
          std::min(std::min(above[x - 1], above[x + 1]), std::min(below[x - 1], below[x + 1]));
      if (!(value <= std::min(sides, corners))) continue;
      const float spread = ground.spread_at(static_cast<std::int64_t>(x), y);
      if (!(value < level[x] - 4 * std::max(noise, spread))) continue;
      // Mean of the floor and its darkest side, so that single dead pixels do not count.
      floors.push_back({0.5F * (value + sides), level[x]});
      const float around = 0.25F * (here[x - 1] + here[x + 1] + above[x] + below[x]);
      if (level[x] - around > kFlat * (level[x] - value)) flat.push_back(floors.back());
    }
  }
  // A flat floor is full shadow; pointed floors are brightened by blur.
  auto& known = flat.size() >= 4 ? flat : floors;
  if (known.empty()) return low_quantile(image);
  const auto low = std::max<std::size_t>(std::min<std::size_t>(2, known.size() / 4), known.size() / 50);
  const auto rank = known.begin() + static_cast<std::ptrdiff_t>(std::min(known.size() - 1, low));
  std::nth_element(known.begin(), rank, known.end(),
                   [](const Floor& a, const Floor& b) { return a.value < b.value; });
  if (&known == &flat) return rank->value;
  const float deeper = rank->level - kDeeperThanPointed * (rank->level - rank->value);
  return rank->value >= 0 ? std::max(0.0F, deeper) : deeper;
}

}  // namespace

Grid<float> smooth_alpha(const Grid<float>& alpha) {
  Grid<float> smooth(alpha.columns(), alpha.rows());
  if (alpha.columns() == 0) return smooth;
  const auto rows = alpha.rows();
  const auto columns = static_cast<std::size_t>(alpha.columns());
  std::vector<float> sum(columns);
  for (std::int64_t y = 0; y < rows; ++y) {
    const auto above = alpha.row(std::max<std::int64_t>(0, y - 1)), here = alpha.row(y);
    const auto below = alpha.row(std::min(rows - 1, y + 1));
    const auto dim = [](float a) { return std::max(kBrightestSmoothed, a); };
    for (std::size_t x = 0; x < columns; ++x)
      sum[x] = kSide * (dim(above[x]) + dim(below[x])) + kCentre * dim(here[x]);
    const auto out = smooth.row(y);
    for (std::size_t x = 1; x + 1 < columns; ++x)
      out[x] = kSide * (sum[x - 1] + sum[x + 1]) + kCentre * sum[x];
    out[0] = sum[0];
    out[columns - 1] = sum[columns - 1];
  }
  return smooth;
}

float ShadowMap::texture_at(double x, double y) const {
  const auto c = std::clamp<std::int64_t>(static_cast<std::int64_t>(x) / tile, 0, texture.columns() - 1);
  const auto r = std::clamp<std::int64_t>(static_cast<std::int64_t>(y) / tile, 0, texture.rows() - 1);
  return texture(c, r);
}

std::optional<ShadowMap> map_shadows(const Pixels& image, int tile, std::optional<float> umbra) {
  if (image.columns() < 5 || image.rows() < 5) return std::nullopt;
  const LocalBackground ground = local_background(image, tile);
  const float noise = noise_sd(image);
  if (!umbra) umbra = umbra_of(image, ground, noise);
  std::vector<float> levels;
  for (const float level : ground.level.cells())
    if (std::isfinite(level)) levels.push_back(level);
  if (!umbra || levels.empty()) return std::nullopt;
  // Lit tiles only: under a low sun most of an image may lie in the shadow of hills and craters.
  const float brightest = *std::max_element(levels.begin(), levels.end());
  std::erase_if(levels, [&](float level) { return !(level >= *umbra + 0.25F * (brightest - *umbra)); });
  const float typical_depth = levels.empty() ? 0 : median_of(levels) - *umbra;
  if (!(typical_depth > 4 * noise) || !(typical_depth > 0)) return std::nullopt;

  ShadowMap map{.alpha = Grid<float>(image.columns(), image.rows()),
                .smooth = {},
                .umbra = *umbra,
                .noise = noise / typical_depth,
                .texture = ground.spread,
                .tile = tile,
                .shaded = {}};
  // Ground almost as dark as the umbra is itself in shadow, so no rock casts one there.
  const float min_depth = std::max(kShaded * typical_depth, 4 * noise);
  for (std::int64_t r = 0; r < map.texture.rows(); ++r)
    for (std::int64_t c = 0; c < map.texture.columns(); ++c)
      map.texture(c, r) /= std::max(min_depth, ground.level(c, r) - *umbra);
  std::vector<float> level(static_cast<std::size_t>(image.columns()));
  for (std::int64_t y = 0; y < image.rows(); ++y) {
    ground.read_row(y, level, {});
    const auto in = image.row(y);
    const auto out = map.alpha.row(y);
    for (const float value : in) {
      map.shaded.pixels += value == value;
      map.shaded.shaded += value < *umbra + kShaded * typical_depth;
    }
    for (std::size_t x = 0; x < level.size(); ++x) {
      const float depth = level[x] - *umbra;
      const float alpha = (level[x] - in[x]) / depth;
      out[x] = depth > min_depth && alpha == alpha ? std::clamp(alpha, kBrightest, kDarkest) : 0;
    }
  }
  map.smooth = smooth_alpha(map.alpha);
  return map;
}

}  // namespace waymark::pipeline

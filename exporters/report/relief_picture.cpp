// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/relief_picture.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::exporters {
namespace {

constexpr Colour kDeepWater{92, 132, 163}, kShallowWater{176, 204, 219};
constexpr double kSteep = 0.55;  // slope to which the steep ones are exaggerated, about 29 degrees

struct Slope {
  double east = 0, north = 0;  ///< rise over run
};

float or_else(float height, float instead) {
  return std::isnan(height) ? instead : height;
}

/// Horn's slope of a 3x3 neighbourhood; neighbours without a height count as level with the cell.
Slope slope_at(const Relief& relief, const Grid<float>& heights, std::int64_t c, std::int64_t r) {
  const float here = heights(c, r);
  const auto at = [&](std::int64_t dc, std::int64_t dr) {
    const std::int64_t column = std::clamp<std::int64_t>(c + dc, 0, heights.columns() - 1);
    const std::int64_t row = std::clamp<std::int64_t>(r + dr, 0, heights.rows() - 1);
    return static_cast<double>(or_else(heights(column, row), here));
  };
  return {
      (at(1, -1) + 2 * at(1, 0) + at(1, 1) - at(-1, -1) - 2 * at(-1, 0) - at(-1, 1)) / (8 * relief.cell_x),
      (at(-1, -1) + 2 * at(0, -1) + at(1, -1) - at(-1, 1) - 2 * at(0, 1) - at(1, 1)) / (8 * relief.cell_y)};
}

template <class T>
T percentile(std::vector<T> values, double share) {
  if (values.empty()) return T{};
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Returns the brightness in [-1, 1] of a slope, 0 on level ground, from three lights about the north-west.
double brightness(const Slope& slope) {
  struct Light {
    double azimuth, weight;
  };
  constexpr Light lights[] = {{315, 0.6}, {255, 0.2}, {15, 0.2}};
  constexpr double altitude = 42 * kRadiansPerDegree;
  const double length = std::sqrt(1 + slope.east * slope.east + slope.north * slope.north);
  double sum = 0;
  for (const Light& light : lights) {
    const double towards = -std::sin(light.azimuth * kRadiansPerDegree) * slope.east -
                           std::cos(light.azimuth * kRadiansPerDegree) * slope.north;
    sum += light.weight * (std::sin(altitude) + std::cos(altitude) * towards) / length;
  }
  const double level = std::sin(altitude);
  return sum > level ? (sum - level) / (1 - level) : std::max(-1.0, (sum - level) / level);
}

/// Computes the brightness of every cell with exaggerated slopes; 0 for cells without a height.
Grid<float> lit(const Relief& relief, const Grid<float>& heights) {
  Grid<float> east(heights.columns(), heights.rows()), north = east;
  std::vector<float> steepness;
  for (std::int64_t r = 0; r < heights.rows(); ++r)
    for (std::int64_t c = 0; c < heights.columns(); ++c) {
      if (std::isnan(heights(c, r))) continue;
      const Slope slope = slope_at(relief, heights, c, r);
      east(c, r) = static_cast<float>(slope.east);
      north(c, r) = static_cast<float>(slope.north);
      const float steep = std::hypot(east(c, r), north(c, r));
      if (steep > 0) steepness.push_back(steep);
    }
  const double usual = percentile(std::move(steepness), 0.85);
  const double exaggeration = usual > 0 ? kSteep / usual : 1;
  for (std::size_t i = 0; i < east.cells().size(); ++i)
    east.cells()[i] =
        static_cast<float>(brightness({exaggeration * east.cells()[i], exaggeration * north.cells()[i]}));
  return east;
}

/// Averages the known heights in a square of 2 * reach + 1 cells; three passes are close to a Gaussian.
Grid<float> blurred(Grid<float> heights, std::int64_t reach) {
  const auto pass = [reach](auto cell, std::int64_t count) {
    std::vector<double> sum(static_cast<std::size_t>(count) + 1), known = sum;
    for (std::int64_t i = 0; i < count; ++i) {
      const float height = cell(i);
      const auto at = static_cast<std::size_t>(i);
      sum[at + 1] = sum[at] + or_else(height, 0);
      known[at + 1] = known[at] + (std::isnan(height) ? 0 : 1);
    }
    for (std::int64_t i = 0; i < count; ++i) {
      const auto from = static_cast<std::size_t>(std::max<std::int64_t>(0, i - reach));
      const auto to = static_cast<std::size_t>(std::min(count, i + reach + 1));
      if (!std::isnan(cell(i)))
        cell(i) = static_cast<float>((sum[to] - sum[from]) / (known[to] - known[from]));
    }
  };
  for (int repeat = 0; repeat < 3; ++repeat) {
    for (std::int64_t r = 0; r < heights.rows(); ++r)
      pass([&](std::int64_t c) -> float& { return heights(c, r); }, heights.columns());
    for (std::int64_t c = 0; c < heights.columns(); ++c)
      pass([&](std::int64_t r) -> float& { return heights(c, r); }, heights.rows());
  }
  return heights;
}

std::uint8_t mix(double a, double b, double share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(a + (b - a) * share, 0.0, 255.0)));
}

Colour mix(const Colour& a, const Colour& b, double share) {
  return {mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share)};
}

/// Tints shadows towards a cool dark and lights towards a warm white, as in painted relief.
Colour lit_colour(const Colour& colour, double light) {
  constexpr Colour shadow{32, 36, 58}, sun{255, 251, 240};
  return light < 0 ? mix(colour, shadow, -0.62 * light) : mix(colour, sun, 0.55 * light);
}

}  // namespace

Colour HypsometricTint::operator()(double height) const {
  if (water && height <= 0)
    return mix(kShallowWater, kDeepWater, lowest < 0 ? std::min(1.0, height / lowest) : 0);
  const double from = water ? std::max(lowest, 0.0) : lowest;
  const double share = highest > from ? std::clamp((height - from) / (highest - from), 0.0, 1.0) : 0.5;
  const double at = share * static_cast<double>(land.size() - 1);
  const auto step = std::min(static_cast<std::size_t>(at), land.size() - 2);
  return mix(land[step], land[step + 1], at - static_cast<double>(step));
}

HypsometricTint hypsometric_tint(const Relief& relief, const Body& body) {
  std::vector<float> heights;
  for (const float height : relief.heights.cells())
    if (!std::isnan(height)) heights.push_back(height);
  HypsometricTint tint;
  tint.lowest = percentile(heights, 0.005);
  tint.highest = std::max<double>(percentile(std::move(heights), 0.995), tint.lowest + 1e-3);
  if (body.name == earth().name) {
    tint.water = true;
    tint.land = {{132, 160, 112}, {171, 187, 132}, {214, 207, 161}, {205, 178, 139},
                 {178, 152, 132}, {216, 208, 202}, {250, 249, 248}};
  } else if (body.name == moon().name) {
    tint.land = {{70, 70, 76}, {118, 117, 118}, {168, 166, 162}, {214, 211, 204}, {246, 244, 239}};
  } else if (body.name == mars().name) {
    tint.land = {{92, 52, 44},    {145, 79, 53},   {190, 118, 75},
                 {218, 165, 114}, {236, 208, 167}, {250, 241, 226}};
  } else {
    tint.land = {{84, 99, 112}, {136, 149, 156}, {190, 197, 196}, {238, 238, 232}};
  }
  return tint;
}

Grid<Colour> shade(const Relief& relief, const HypsometricTint& tint) {
  const std::int64_t forms =
      std::max<std::int64_t>(2, std::max(relief.heights.columns(), relief.heights.rows()) / 90);
  const Grid<float> fine = lit(relief, relief.heights);
  const Grid<float> broad = lit(relief, blurred(relief.heights, forms));
  Grid<Colour> picture(relief.heights.columns(), relief.heights.rows(), Colour{0, 0, 0, 0});
  for (std::size_t i = 0; i < picture.cells().size(); ++i) {
    const float height = relief.heights.cells()[i];
    if (!std::isnan(height))
      picture.cells()[i] = lit_colour(tint(height), 0.68 * fine.cells()[i] + 0.32 * broad.cells()[i]);
  }
  return picture;
}

}  // namespace waymark::exporters

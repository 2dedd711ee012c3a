// SPDX-License-Identifier: Apache-2.0
#include "planning/sun_horizon.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

/// Steps of a ray in cells: one along the axis that it crosses more often.
struct Steps {
  double column, row;  // per step; row southwards
  double metres;       // per step
  std::int64_t count;
};

Steps steps_of(const HorizonRay& ray) {
  const double a = ray.azimuth * kRadiansPerDegree;
  const double column = std::sin(a) / ray.cell_x, row = -std::cos(a) / ray.cell_y;  // per metre
  const double metres = 1 / std::max(std::abs(column), std::abs(row));
  // A step along an axis is exact, so that a cell is not missed by rounding.
  Steps steps{column * metres, row * metres, metres, static_cast<std::int64_t>(ray.reach / metres)};
  if (std::abs(steps.column) >= std::abs(steps.row))
    steps.column = std::copysign(1, steps.column);
  else
    steps.row = std::copysign(1, steps.row);
  if (std::abs(steps.column) < 1e-9) steps.column = 0;  // along an axis, rounded
  if (std::abs(steps.row) < 1e-9) steps.row = 0;
  return steps;
}

/// Height at a position that is on a column or a row; kNoHeight if either cell is unknown or outside.
double height_between(const HeightWindow& heights, double column, double row) {
  const double c = std::floor(column), r = std::floor(row), u = column - c, v = row - r;
  const auto get = [&](double at_column, double at_row) {
    const auto i = static_cast<std::int64_t>(at_column), j = static_cast<std::int64_t>(at_row);
    return heights.contains(i, j) ? heights(i, j) : kNoHeight;
  };
  if (u == 0 && v == 0) return get(c, r);
  if (v == 0) return (1 - u) * get(c, r) + u * get(c + 1, r);
  return (1 - v) * get(c, r) + v * get(c, r + 1);
}

double horizon_of(const HeightWindow& heights, std::int64_t column, std::int64_t row, const HorizonRay& ray,
                  const Steps& steps, double highest) {
  const double own = heights(column, row);
  if (own == kNoHeight) return std::nan("");
  double best = -1e9;  // tangent of the elevation
  for (std::int64_t i = 1; i <= steps.count; ++i) {
    const double n = static_cast<double>(i), distance = n * steps.metres;
    if ((highest - own) / distance <= best) break;
    const double drop = ray.body_radius > 0 ? distance * distance / (2 * ray.body_radius) : 0;
    const double height = height_between(heights, static_cast<double>(column) + n * steps.column,
                                         static_cast<double>(row) + n * steps.row);
    best = std::max(best, (height - drop - own) / distance);
  }
  return std::atan(best) / kRadiansPerDegree;
}

Grid<float> horizons(const HeightWindow& heights, const Window& inner, const HorizonRay& ray,
                     double highest) {
  const Steps steps = steps_of(ray);
  Grid<float> out(inner.columns, inner.rows);
  for (std::int64_t r = 0; r < inner.rows; ++r)
    for (std::int64_t c = 0; c < inner.columns; ++c)
      out(c, r) =
          static_cast<float>(horizon_of(heights, inner.column + c, inner.row + r, ray, steps, highest));
  return out;
}

}  // namespace

HorizonMargin horizon_margin(const HorizonRay& ray) {
  const Steps steps = steps_of(ray);
  const double n = static_cast<double>(steps.count);
  const auto cells = [](double reach) {
    return static_cast<std::int64_t>(std::max(0.0, std::ceil(reach))) + 1;
  };
  return {cells(-n * steps.column), cells(n * steps.column), cells(-n * steps.row), cells(n * steps.row)};
}

Grid<float> sun_horizon(const HeightWindow& heights, const Window& inner, const HorizonRay& ray) {
  const auto cells = heights.cells();
  return horizons(heights, inner, ray, cells.empty() ? 0 : *std::ranges::max_element(cells));
}

Grid<float> sun_horizon_directly(const HeightWindow& heights, const Window& inner, const HorizonRay& ray) {
  return horizons(heights, inner, ray, 1e12);
}

}  // namespace waymark::planning

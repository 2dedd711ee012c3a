// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_width.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark::pipeline {
namespace {

/// Darkness is squared, since lawns are as green as crowns, but brighter. NaN where there is no data.
double dark_green(const ColourWindow& image, std::int64_t column, std::int64_t row) {
  const auto band = [&](std::size_t b) { return double(image.bands[b](column, row)); };
  const double red = band(0), green = band(1), blue = band(2);
  const double index = image.bands.size() > 3
                           ? (band(3) - red) / std::max(band(3) + red, 0.01)
                           : 12 * (2 * green - red - blue) / std::max(red + green + blue, 0.01);
  const double dark = std::clamp(1 - (red + green + blue) / 3, 0.0, 1.0);
  return std::max(index, 0.0) * dark * dark;
}

}  // namespace

double crown_width(const ColourWindow& image, const CanopyCell& top) {
  const auto rings = static_cast<std::int64_t>(kMaxCrownDiameter / 2 / image.cell) + 1;
  std::vector<double> sum(static_cast<std::size_t>(rings) + 1), count(sum.size());
  for (std::int64_t dr = -rings; dr <= rings; ++dr)
    for (std::int64_t dc = -rings; dc <= rings; ++dc) {
      const std::int64_t c = top.column + dc - image.cells.column, r = top.row + dr - image.cells.row;
      const auto ring = static_cast<std::size_t>(std::llround(std::hypot(double(dc), double(dr))));
      if (ring >= sum.size() || !image.bands[0].contains(c, r)) continue;
      const double green = dark_green(image, c, r);
      if (!std::isnan(green)) sum[ring] += green, count[ring] += 1;
    }
  const auto mean = [&](std::size_t ring) { return count[ring] > 0 ? sum[ring] / count[ring] : 0; };
  const double middle = (sum[0] + sum[1]) / std::max(1.0, count[0] + count[1]);
  double before = middle;
  for (std::size_t ring = 1; ring < sum.size(); ++ring) {
    const double here = mean(ring);
    if (here < middle / 2) {  // interpolates the half value between the two rings
      const double part = before > here ? (before - middle / 2) / (before - here) : 0;
      return std::clamp(2 * (double(ring) - 1 + part) * image.cell, 2 * image.cell, kMaxCrownDiameter);
    }
    before = here;
  }
  return kMaxCrownDiameter;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/filled_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::pipeline {
namespace {

// Half-size image of the means of known pixels; NaN where none is known.
Pixels half_size_known(const Pixels& fine) {
  Pixels coarse((fine.columns() + 1) / 2, (fine.rows() + 1) / 2);
  for (std::int64_t y = 0; y < coarse.rows(); ++y)
    for (std::int64_t x = 0; x < coarse.columns(); ++x) {
      double sum = 0, n = 0;
      for (std::int64_t j = 2 * y; j < std::min(2 * y + 2, fine.rows()); ++j)
        for (std::int64_t i = 2 * x; i < std::min(2 * x + 2, fine.columns()); ++i)
          if (std::isfinite(fine(i, j))) sum += fine(i, j), ++n;
      coarse(x, y) = n > 0 ? static_cast<float>(sum / n) : std::numeric_limits<float>::quiet_NaN();
    }
  return coarse;
}

// Pull-push: holes take the value of the coarser level (Gortler et al. 1996).
void fill_from_coarser(Pixels& image) {
  const bool holes =
      std::any_of(image.cells().begin(), image.cells().end(), [](float v) { return !std::isfinite(v); });
  if (!holes) return;
  if (image.columns() <= 1 && image.rows() <= 1) {
    image(0, 0) = 0;
    return;
  }
  Pixels coarse = half_size_known(image);
  fill_from_coarser(coarse);
  for (std::int64_t y = 0; y < image.rows(); ++y)
    for (std::int64_t x = 0; x < image.columns(); ++x)
      if (!std::isfinite(image(x, y))) image(x, y) = coarse(x / 2, y / 2);
}

}  // namespace

double FilledImage::known_fraction(double x, double y, double size) const {
  const auto at = [](double edge, std::int64_t end) {
    return std::clamp<std::int64_t>(std::llround(edge), 0, end);
  };
  const std::int64_t x0 = at(x - size / 2 + 0.5, pixels.columns()),
                     x1 = at(x + size / 2 + 0.5, pixels.columns());
  const std::int64_t y0 = at(y - size / 2 + 0.5, pixels.rows()), y1 = at(y + size / 2 + 0.5, pixels.rows());
  const double area = std::max(1.0, size * size);
  if (complete) return std::min(1.0, double(x1 - x0) * double(y1 - y0) / area);
  const double count = double(known_sum(x1, y1) - known_sum(x0, y1) - known_sum(x1, y0) + known_sum(x0, y0));
  return std::min(1.0, count / area);
}

FilledImage fill_holes(const Pixels& image) {
  FilledImage result{.pixels = image, .known_sum = {}, .complete = true, .flat = true};
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (const float v : image.cells())
    if (std::isfinite(v))
      lowest = std::min(lowest, v), highest = std::max(highest, v);
    else
      result.complete = false;
  result.flat = !(highest > lowest);
  if (result.complete || result.flat) return result;
  result.known_sum = Grid<std::int64_t>(image.columns() + 1, image.rows() + 1, 0);
  for (std::int64_t y = 0; y < image.rows(); ++y)
    for (std::int64_t x = 0; x < image.columns(); ++x)
      result.known_sum(x + 1, y + 1) = (std::isfinite(image(x, y)) ? 1 : 0) + result.known_sum(x, y + 1) +
                                       result.known_sum(x + 1, y) - result.known_sum(x, y);
  fill_from_coarser(result.pixels);
  return result;
}

}  // namespace waymark::pipeline

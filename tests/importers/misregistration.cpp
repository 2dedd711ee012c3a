// SPDX-License-Identifier: Apache-2.0
#include "tests/importers/misregistration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark::test {
namespace {

constexpr int kHalf = 12;   // of a patch, pixels
constexpr int kSearch = 8;  // pixels in each direction
constexpr int kSide = 2 * kHalf + 1;

std::optional<double> sample(const Pixels& image, const Eigen::Vector2d& at) {
  const auto c = static_cast<std::int64_t>(std::floor(at.x())),
             r = static_cast<std::int64_t>(std::floor(at.y()));
  if (c < 0 || r < 0 || c + 1 >= image.columns() || r + 1 >= image.rows()) return std::nullopt;
  const double u = at.x() - static_cast<double>(c), v = at.y() - static_cast<double>(r);
  const double value = (1 - v) * ((1 - u) * image(c, r) + u * image(c + 1, r)) +
                       v * ((1 - u) * image(c, r + 1) + u * image(c + 1, r + 1));
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// Returns the photo resampled around a position, north up.
std::optional<Grid<double>> laid_out(const Photo& photo, const Terrain& terrain, double x, double y,
                                     double step, int half) {
  Grid<double> patch(2 * half + 1, 2 * half + 1);
  for (int r = -half; r <= half; ++r)
    for (int c = -half; c <= half; ++c) {
      const double east = x + c * step, north = y - r * step;
      const auto height = terrain.height(east, north);
      const auto seen = height ? project(photo.view, {Eigen::Vector3d(east, north, *height)}) : std::nullopt;
      const auto value = seen ? sample(photo.pixels, *seen) : std::nullopt;
      if (!value) return std::nullopt;
      patch(c + half, r + half) = *value;
    }
  return patch;
}

struct Moments {
  double mean = 0, sd = 0;
};

Moments moments(const Grid<double>& patch, int column, int row) {
  double sum = 0, squares = 0;
  for (int r = 0; r < kSide; ++r)
    for (int c = 0; c < kSide; ++c) {
      const double v = patch(column + c, row + r);
      sum += v;
      squares += v * v;
    }
  const double n = kSide * kSide, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

double correlation(const Grid<double>& small, const Moments& of_small, const Grid<double>& large, int column,
                   int row) {
  const Moments there = moments(large, column, row);
  double sum = 0;
  for (int r = 0; r < kSide; ++r)
    for (int c = 0; c < kSide; ++c)
      sum += (small(c, r) - of_small.mean) * (large(column + c, row + r) - there.mean);
  return sum / (kSide * kSide * of_small.sd * there.sd + 1e-9);
}

double peak(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

std::optional<Eigen::Vector2d> shift_at(const Photo& a, const Photo& b, const Terrain& terrain, double x,
                                        double y, double step) {
  const auto small = laid_out(a, terrain, x, y, step, kHalf);
  const auto large = small ? laid_out(b, terrain, x, y, step, kHalf + kSearch) : std::nullopt;
  if (!large) return std::nullopt;
  const Moments of_small = moments(*small, 0, 0);
  Grid<double> match(2 * kSearch + 1, 2 * kSearch + 1);
  int best_c = 0, best_r = 0;
  for (int r = 0; r <= 2 * kSearch; ++r)
    for (int c = 0; c <= 2 * kSearch; ++c) {
      match(c, r) = correlation(*small, of_small, *large, c, r);
      if (match(c, r) > match(best_c, best_r)) best_c = c, best_r = r;
    }
  const bool inside = best_c > 0 && best_r > 0 && best_c < 2 * kSearch && best_r < 2 * kSearch;
  if (!inside || match(best_c, best_r) < 0.7) return std::nullopt;
  const double at = match(best_c, best_r);
  const double c = best_c - kSearch + peak(match(best_c - 1, best_r), at, match(best_c + 1, best_r));
  const double r = best_r - kSearch + peak(match(best_c, best_r - 1), at, match(best_c, best_r + 1));
  return Eigen::Vector2d(c * step, -r * step);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace

Photo photo(const ImageSource& image) {
  return {image.read({0, 0, image.info().columns, image.info().rows}), image.info().view.value()};
}

std::vector<Eigen::Vector2d> shifts(const Photo& a, const Photo& b, const Terrain& terrain,
                                    double metres_per_pixel, int places_across) {
  std::vector<Eigen::Vector2d> found;
  const double width = terrain.step_x() * static_cast<double>(terrain.heights().columns() - 1);
  const double height = terrain.step_y() * static_cast<double>(terrain.heights().rows() - 1);
  for (int i = 1; i < places_across; ++i)
    for (int j = 1; j < places_across; ++j)
      if (const auto shift = shift_at(a, b, terrain, terrain.x0() + width * i / places_across,
                                      terrain.y0() - height * j / places_across, metres_per_pixel))
        found.push_back(*shift);
  return found;
}

double median_length(const std::vector<Eigen::Vector2d>& shifts) {
  std::vector<double> lengths;
  for (const auto& shift : shifts) lengths.push_back(shift.norm());
  return median(lengths);
}

double common_shift(const std::vector<Eigen::Vector2d>& shifts) {
  std::vector<double> east, north;
  for (const auto& shift : shifts) east.push_back(shift.x()), north.push_back(shift.y());
  return std::hypot(median(east), median(north));
}

}  // namespace waymark::test

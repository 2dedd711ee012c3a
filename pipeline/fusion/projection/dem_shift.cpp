// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/dem_shift.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pipeline/fusion/projection/position_covariance.hpp"
#include "pipeline/fusion/projection/shaded_relief.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"

namespace waymark::pipeline {
namespace {

constexpr float kNotSeen = std::numeric_limits<float>::quiet_NaN();

float pixel_at(const Pixels& pixels, double x, double y) {
  const auto i = static_cast<std::int64_t>(std::floor(x)), j = static_cast<std::int64_t>(std::floor(y));
  if (!(i >= 0 && j >= 0 && i + 1 < pixels.columns() && j + 1 < pixels.rows())) return kNotSeen;
  const auto u = static_cast<float>(x - double(i)), v = static_cast<float>(y - double(j));
  return std::lerp(std::lerp(pixels(i, j), pixels(i + 1, j), u),
                   std::lerp(pixels(i, j + 1), pixels(i + 1, j + 1), u), v);
}

// Brightness of the cells as the given pose sees them.
Grid<float> ground_brightness(const Pixels& pixels, const PosedCamera& view, const ShadedRelief& relief,
                              int factor) {
  Grid<float> seen(relief.height.columns(), relief.height.rows(), kNotSeen);
  tbb::parallel_for(std::int64_t{0}, seen.rows(), [&](std::int64_t r) {
    for (std::int64_t c = 0; c < seen.columns(); ++c) {
      const Eigen::Vector3d at = relief.at(c, r);
      if (std::isnan(at.z())) continue;
      if (const auto pixel = project(view, Point<GridFrame>{at}))
        seen(c, r) = pixel_at(pixels, (pixel->x() + 0.5) / factor - 0.5, (pixel->y() + 0.5) / factor - 0.5);
    }
  });
  return seen;
}

// Subtracts the local mean, scales to unit variance and clamps at 3: shadows of rocks are not slopes.
Grid<float> fine_structure(const Grid<float>& values, int radius) {
  Grid<float> fine = high_pass(values, radius);
  double squares = 0, n = 0;
  for (const float v : fine.cells())
    if (!std::isnan(v)) squares += double(v) * double(v), ++n;
  if (!(squares > 0)) return Grid<float>(fine.columns(), fine.rows(), kNotSeen);
  const auto scale = static_cast<float>(std::sqrt(n / squares));
  for (float& v : fine.cells()) v = std::isnan(v) ? v : std::clamp(v * scale, -3.0F, 3.0F);
  return fine;
}

/// Values with zeros where unknown, their squares, and ones where known.
struct MaskedGrid {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix value, square, known;

  explicit MaskedGrid(const Grid<float>& grid)
      : value(grid.rows(), grid.columns()), known(grid.rows(), grid.columns()) {
    for (std::int64_t r = 0; r < grid.rows(); ++r)
      for (std::int64_t c = 0; c < grid.columns(); ++c) {
        const float v = grid(c, r);
        known(r, c) = std::isnan(v) ? 0.0F : 1.0F;
        value(r, c) = std::isnan(v) ? 0.0F : v;
      }
    square = value.cwiseProduct(value);
  }
};

// Correlation of seen(at + shift) with expected(at) over the cells that both know.
double correlation(const MaskedGrid& seen, const MaskedGrid& expected, std::int64_t east, std::int64_t south,
                   double min_known) {
  const std::int64_t width = expected.value.cols() - std::abs(east), left = std::max<std::int64_t>(0, -east),
                     top = std::max<std::int64_t>(0, -south),
                     bottom = expected.value.rows() - std::max<std::int64_t>(0, south);
  if (width <= 0) return std::nan("");
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::int64_t r = top; r < bottom; ++r) {
    const auto row = [&](const MaskedGrid::Matrix& m, std::int64_t at, std::int64_t from) {
      return m.row(at).segment(from, width);
    };
    const auto known = row(expected.known, r, left), shown = row(seen.known, r + south, left + east);
    n += double(known.dot(shown));
    a += double(row(seen.value, r + south, left + east).dot(known));
    aa += double(row(seen.square, r + south, left + east).dot(known));
    b += double(row(expected.value, r, left).dot(shown));
    bb += double(row(expected.square, r, left).dot(shown));
    ab += double(row(expected.value, r, left).dot(row(seen.value, r + south, left + east)));
  }
  if (!(n >= min_known)) return std::nan("");
  const double variance = (aa - a * a / n) * (bb - b * b / n);
  return variance > 0 ? (ab - a * b / n) / std::sqrt(variance) : std::nan("");
}

/// Correlations of all shifts; cell (radius, radius) is no shift.
struct CorrelationMap {
  Grid<double> value;
  std::int64_t radius = 0;
};

CorrelationMap correlate(const MaskedGrid& seen, const MaskedGrid& expected, int radius, double min_known) {
  const std::int64_t side = 2 * radius + 1;
  CorrelationMap map{Grid<double>(side, side, 0), radius};
  tbb::parallel_for(std::int64_t{0}, side, [&](std::int64_t r) {
    for (std::int64_t c = 0; c < side; ++c)
      map.value(c, r) = correlation(seen, expected, c - radius, r - radius, min_known);
  });
  return map;
}

/// Shift in cells: columns, rows.
struct CellShift {
  Eigen::Vector2d cells = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

std::optional<CellShift> find_maximum(const CorrelationMap& map, const DemShiftRules& rules) {
  const Grid<double>& v = map.value;
  std::int64_t column = -1, row = -1;
  double best = rules.min_correlation;
  for (std::int64_t r = 0; r < v.rows(); ++r)
    for (std::int64_t c = 0; c < v.columns(); ++c) {
      if (std::isnan(v(c, r))) return std::nullopt;
      if (v(c, r) > best) best = v(c, r), column = c, row = r;
    }
  if (column < 1 || row < 1 || column + 1 >= v.columns() || row + 1 >= v.rows()) return std::nullopt;

  double n = 0, squares = 0, second = -1;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  // of the gradients away from the maximum
  for (std::int64_t r = 1; r + 1 < v.rows(); ++r)
    for (std::int64_t c = 1; c + 1 < v.columns(); ++c) {
      if (std::hypot(double(c - column), double(r - row)) <= rules.peak_radius) continue;
      const Eigen::Vector2d gradient((v(c + 1, r) - v(c - 1, r)) / 2, (v(c, r + 1) - v(c, r - 1)) / 2);
      scatter += gradient * gradient.transpose();
      squares += v(c, r) * v(c, r), ++n;
      second = std::max(second, v(c, r));
    }
  const double noise = std::sqrt(squares / std::max(n, 1.0));
  if (!(best >= rules.min_significance * noise) || !(best - second >= rules.min_lead * noise))
    return std::nullopt;

  const Eigen::Vector2d slope((v(column + 1, row) - v(column - 1, row)) / 2,
                              (v(column, row + 1) - v(column, row - 1)) / 2);
  const double mixed =
      (v(column + 1, row + 1) - v(column - 1, row + 1) - v(column + 1, row - 1) + v(column - 1, row - 1)) / 4;
  Eigen::Matrix2d curvature;
  curvature << v(column + 1, row) + v(column - 1, row) - 2 * best, mixed, mixed,
      v(column, row + 1) + v(column, row - 1) - 2 * best;
  if (!(curvature.determinant() > 0) || !(curvature.trace() < 0)) return std::nullopt;
  const Eigen::Matrix2d inverse = curvature.inverse();
  const Eigen::Vector2d beside = -inverse * slope;
  if (!(beside.norm() < 1.5)) return std::nullopt;
  CellShift found;
  found.cells = Eigen::Vector2d(double(column - map.radius), double(row - map.radius)) + beside;
  found.covariance = inverse * (scatter / n) * inverse;
  return found;
}

// Covariance that the stated pose gives the point in the middle of an image, east and north.
Eigen::Matrix2d stated_covariance(const ImageView& image, const Eigen::Vector3d& ground) {
  const Eigen::Vector3d centre = image.view->centre().xyz;
  const auto per_pose = pose_jacobian(image, {{centre}, {(ground - centre).normalized()}},
                                      GroundPlane{ground, Eigen::Vector2d::Zero()});
  return (per_pose * image.view->covariance * per_pose.transpose()).topLeftCorner<2, 2>();
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

std::optional<DemShift> measure_dem_shift(const Pixels& pixels, const ImageView& image,
                                          const Terrain& terrain, double metres_per_unit,
                                          const DemShiftRules& rules) {
  if (!image.view || !image.sun || !(image.gsd > 0)) return std::nullopt;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& ring : image.footprint)
    for (const auto& corner : ring)
      low = low.cwiseMin(corner * metres_per_unit), high = high.cwiseMax(corner * metres_per_unit);
  if (!(low.array() < high.array()).all()) return std::nullopt;
  const double step = std::max(terrain.step_x(), terrain.step_y());
  const double coarseness = std::max({1.0, 1.5 * image.gsd / step,
                                      std::sqrt((high - low).prod() / (terrain.step_x() * terrain.step_y()) /
                                                static_cast<double>(rules.max_cells))});
  const ShadedRelief relief =
      shaded_relief(terrain, low, high, static_cast<int>(std::ceil(coarseness - 1e-9)), *image.sun);
  if (relief.height.columns() < 8 || relief.height.rows() < 8) return std::nullopt;
  const int factor = std::max(1, static_cast<int>(std::min(relief.step_x, relief.step_y) / image.gsd / 2));
  const Grid<float> seen = ground_brightness(downsample(pixels, factor), *image.view, relief, factor);
  const CorrelationMap map = correlate(MaskedGrid(fine_structure(seen, rules.fine_radius)),
                                       MaskedGrid(fine_structure(relief.light, rules.fine_radius)),
                                       rules.max_cells_of_shift, rules.min_known);
  const auto found = find_maximum(map, rules);
  if (!found) return std::nullopt;
  const Eigen::Matrix2d metres_per_cell = Eigen::Vector2d(relief.step_x, -relief.step_y).asDiagonal();
  const Eigen::Vector2d middle = (low + high) / 2;
  const double height =
      terrain.height(middle.x(), middle.y()).value_or((terrain.min_height() + terrain.max_height()) / 2);
  DemShift shift;
  shift.metres = metres_per_cell * found->cells;
  shift.covariance = metres_per_cell * found->covariance * metres_per_cell.transpose();
  shift.stated = stated_covariance(image, {middle.x(), middle.y(), height});
  shift.cell = std::max(relief.step_x, relief.step_y);
  return shift;
}

std::optional<CommonShift> common_dem_shift(std::span<const ImageView> images,
                                            const CommonShiftRules& rules) {
  std::vector<double> east, north, stated, own, cells;
  int posed = 0;
  for (const ImageView& image : images) {
    posed += image.view.has_value();
    if (!image.dem_shift) continue;
    east.push_back(image.dem_shift->metres.x()), north.push_back(image.dem_shift->metres.y());
    stated.push_back(image.dem_shift->stated.trace() / 2);
    own.push_back(image.dem_shift->covariance.trace() / 2);
    cells.push_back(image.dem_shift->cell);
  }
  const auto n = static_cast<double>(east.size());
  if (!(n >= rules.min_images) || !(n >= rules.min_fraction * posed)) return std::nullopt;
  CommonShift common;
  common.measured = static_cast<int>(east.size());
  common.metres = {median_of(east), median_of(north)};
  std::vector<double> apart;
  for (std::size_t i = 0; i < east.size(); ++i)
    apart.push_back(std::hypot(east[i] - common.metres.x(), north[i] - common.metres.y()));
  // The median of a Rayleigh distribution is 1.177 standard deviations; that of a mean varies 1.25 times
  // more.
  const double between = 1.25 * median_of(apart) / 1.177 / std::sqrt(n);
  const double within = std::sqrt(median_of(own) / n);
  common.sd = std::hypot(std::max(between, within), rules.sd_of_cell * median_of(cells));
  common.stated_sd = std::sqrt(median_of(stated));
  // Errors of poses may be common to all images, so the stated ones do not average out.
  common.significant = common.metres.norm() > rules.gate * std::hypot(common.sd, common.stated_sd);
  return common;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/orthophoto.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/solve.hpp"
#include "pipeline/reconstruction/surface/image_levels.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::int64_t kOrthoTile = 128;   // cells; images are used tile by tile
constexpr std::int64_t kGainSpacing = 4;   // cells
constexpr std::int64_t kGainRows = 32;     // summed at a time
constexpr double kMaxLogDifference = 0.7;  // a factor of 2: beyond it, one of the two is a shadow

class Rectifier {
 public:
  Rectifier(const std::vector<SurfaceView>& views, const SurfaceGrid& grid, const Grid<float>& heights,
            int split, std::size_t image_bytes, std::function<void(double)> progress)
      : views_(views),
        grid_(grid),
        heights_(heights),
        split_(split),
        images_(views, image_bytes),
        progress_(std::move(progress)) {
    if (grid.columns > 1 && grid.rows > 1) relief_ = terrain_of(median_filter(heights), grid);
    out_.grid = grid.with_cell(grid.cell / split);
    out_.brightness = Grid<float>(out_.grid.columns, out_.grid.rows, std::numeric_limits<float>::quiet_NaN());
    out_.source = Grid<std::uint16_t>(out_.grid.columns, out_.grid.rows, 0);
  }

  Orthophoto run() {
    measure_gains();
    const std::int64_t across = (grid_.columns + kOrthoTile - 1) / kOrthoTile;
    const std::int64_t down = (grid_.rows + kOrthoTile - 1) / kOrthoTile;
    tbb::parallel_for(std::int64_t{0}, across * down, [&](std::int64_t n) {
      const std::int64_t c0 = n % across * kOrthoTile, r0 = n / across * kOrthoTile;
      for (std::int64_t r = r0; r < std::min(r0 + kOrthoTile, grid_.rows); ++r)
        for (std::int64_t c = c0; c < std::min(c0 + kOrthoTile, grid_.columns); ++c) fill_cell(c, r);
      if (progress_) progress_(0.5 / double(across * down));
    });
    return std::move(out_);
  }

 private:
  Eigen::Vector3d cell_point(std::int64_t c, std::int64_t r) const {
    return {grid_.x(double(c)), grid_.y(double(r)), static_cast<double>(heights_(c, r))};
  }

  // Sine of the ray's elevation, less where pixels are coarser than those of the mosaic; `std::nullopt` where
  // the view does not see the point.
  std::optional<double> fitness(std::size_t v, const Eigen::Vector3d& point) const {
    const auto pixel = project(views_[v].view, {point});
    if (!pixel || !in_image(views_[v].view.camera, *pixel, 1)) return std::nullopt;
    const Eigen::Vector3d towards = (views_[v].view.centre().xyz - point).normalized();
    if (!(towards.z() > 0)) return std::nullopt;
    const double gsd = ground_sample_distance(views_[v].view, point);
    return towards.z() * std::min(1.0, grid_.cell / split_ / gsd);
  }

  bool visible(std::size_t v, const Eigen::Vector3d& point) const {
    if (!relief_) return true;
    const Eigen::Vector3d raised = point + Eigen::Vector3d(0, 0, grid_.cell);
    return !relief_->in_shadow({raised}, {(views_[v].view.centre().xyz - raised).normalized()});
  }

  std::optional<float> brightness(std::size_t v, const Eigen::Vector3d& point) {
    const auto pixel = project(views_[v].view, {point});
    if (!pixel) return std::nullopt;
    const double gsd = ground_sample_distance(views_[v].view, point);
    const int level = std::clamp(static_cast<int>(std::lround(std::log2(grid_.cell / split_ / gsd))), 0, 8);
    const double scale = 1 << level;
    const float value = sample_level(*images_.get(v, level), (pixel->x() + 0.5) / scale - 0.5,
                                     (pixel->y() + 0.5) / scale - 0.5);
    return std::isnan(value) ? std::nullopt : std::optional(value);
  }

  void measure_gains() {
    const auto n = static_cast<std::int64_t>(views_.size());
    struct Row {
      Grid<double> sums, counts;
    };
    const std::int64_t rows = (grid_.rows + kGainSpacing - 1) / kGainSpacing;
    Row all{Grid<double>(n, n, 0), Grid<double>(n, n, 0)};
    for (std::int64_t begin = 0; begin < rows; begin += kGainRows) {  // bounds the memory of the sums
      const std::int64_t count = std::min(kGainRows, rows - begin);
      std::vector<Row> found(static_cast<std::size_t>(count),
                             Row{Grid<double>(n, n, 0), Grid<double>(n, n, 0)});
      tbb::parallel_for(std::int64_t{0}, count, [&](std::int64_t row) {
        Row& here = found[static_cast<std::size_t>(row)];
        for (std::int64_t c = 0; c < grid_.columns; c += kGainSpacing)
          compare_views(c, (begin + row) * kGainSpacing, here.sums, here.counts);
        if (progress_) progress_(0.5 / double(rows));
      });
      for (const Row& row : found)
        for (std::size_t i = 0; i < all.sums.cells().size(); ++i) {
          all.sums.cells()[i] += row.sums.cells()[i];
          all.counts.cells()[i] += row.counts.cells()[i];
        }
    }
    out_.gains = balance_gains(all.sums, all.counts);
  }

  void compare_views(std::int64_t c, std::int64_t r, Grid<double>& sums, Grid<double>& counts) {
    if (std::isnan(heights_(c, r))) return;
    const Eigen::Vector3d point = cell_point(c, r);
    std::vector<std::pair<std::int64_t, double>> seen;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (!fitness(v, point) || !visible(v, point)) continue;
      const auto value = brightness(v, point);
      if (value && *value > 0)
        seen.emplace_back(static_cast<std::int64_t>(v), std::log(static_cast<double>(*value)));
    }
    for (const auto& [i, a] : seen)
      for (const auto& [j, b] : seen)
        if (i < j && std::abs(a - b) < kMaxLogDifference) {
          sums(i, j) += a - b;
          counts(i, j) += 1;
        }
  }

  void fill_cell(std::int64_t c, std::int64_t r) {
    if (std::isnan(heights_(c, r))) return;
    const Eigen::Vector3d point = cell_point(c, r);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t v = 0; v < views_.size(); ++v)
      if (const auto fit = fitness(v, point)) order.emplace_back(-*fit, v);
    std::ranges::sort(order);
    for (const auto& [fit, v] : order) {
      if (!visible(v, point)) continue;
      for (int j = 0; j < split_; ++j)
        for (int i = 0; i < split_; ++i) fill_pixel(c, r, i, j, v);
      return;
    }
  }

  void fill_pixel(std::int64_t c, std::int64_t r, int i, int j, std::size_t v) {
    const std::int64_t x = c * split_ + i, y = r * split_ + j;
    const double px = out_.grid.x(double(x)), py = out_.grid.y(double(y));
    const double height = relief_ ? relief_->height(px, py).value_or(static_cast<double>(heights_(c, r)))
                                  : static_cast<double>(heights_(c, r));
    const auto value = brightness(v, {px, py, height});
    if (!value) return;
    out_.brightness(x, y) = static_cast<float>(static_cast<double>(*value) * out_.gains[v]);
    out_.source(x, y) = static_cast<std::uint16_t>(v + 1);
  }

  const std::vector<SurfaceView>& views_;
  const SurfaceGrid& grid_;
  const Grid<float>& heights_;
  int split_;
  ImageLevels images_;
  std::function<void(double)> progress_;
  std::optional<Terrain> relief_;
  Orthophoto out_;
};

}  // namespace

std::vector<double> balance_gains(const Grid<double>& sums, const Grid<double>& counts) {
  constexpr double kPull = 1e-3;  // of the mean weight, towards no change
  const Eigen::Index n = counts.columns();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j) {
      const double weight = counts(i, j);
      normal(i, i) += weight;
      normal(j, j) += weight;
      normal(i, j) -= weight;
      normal(j, i) -= weight;
      right(i) -= sums(i, j);
      right(j) += sums(i, j);
    }
  const double pull = n > 0 ? std::max(1e-9, kPull * normal.trace() / double(n)) : 1;
  normal.diagonal().array() += pull;
  const Eigen::VectorXd logs = solve_symmetric(normal, right);
  std::vector<double> gains;
  for (Eigen::Index i = 0; i < n; ++i) gains.push_back(std::exp(logs(i)));
  return gains;
}

Orthophoto make_orthophoto(const std::vector<SurfaceView>& views, const SurfaceGrid& grid,
                           const Grid<float>& heights, int pixels_per_cell, std::size_t image_bytes,
                           const std::function<void(double)>& progress) {
  return Rectifier(views, grid, heights, pixels_per_cell, image_bytes, progress).run();
}

}  // namespace waymark::pipeline

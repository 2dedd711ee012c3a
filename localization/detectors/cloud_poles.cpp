// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_poles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "localization/detectors/cloud_bearings.hpp"
#include "localization/detectors/cloud_columns.hpp"
#include "localization/detectors/cloud_ground.hpp"
#include "localization/detectors/column_flanks.hpp"
#include "localization/detectors/upright_shape.hpp"

namespace waymark::localization {
namespace {

constexpr double kCell = 0.2;             // m
constexpr double kLayer = 0.25;           // m
constexpr int kLayers = 24;               // up to 6 m above the ground
constexpr double kFoot = 0.3;             // m above the ground, below which kerbs and grass are
constexpr double kCore = 0.35;            // m about the axis that belongs to a pole
constexpr double kShape = 0.45;           // m about the mean of the points: reaches the sides of a stem
constexpr int kMinCandidateLayers = 3;    // with points in 3 x 3 cells
constexpr double kMaxRingFraction = 0.2;  // of a layer's points, in the ring around the core
constexpr double kMaxGap = 1.0;           // m between rows of a far pole, or where a sign hides it
constexpr double kRowReach = 2;           // m; columns of a wall seen at a flat angle are that far apart
constexpr double kFlat = 0.93;            // cosine between such a wall and the line of sight
constexpr double kStraight = -0.95;       // cosine between the neighbours on both sides
constexpr double kSame = 0.6;             // m between axes of one pole
constexpr double kMaxCutOff = 0.7;        // of the layers of a pole

/// A point above the ground, and the tangent of its elevation.
struct SeenPoint : RaisedPoint {
  float slope;
};

/// Points above the ground, sorted into cells.
class PointGrid {
 public:
  PointGrid(const PointCloud& cloud, double max_range)
      : cells_(2 * static_cast<int>(std::ceil(max_range / kCell))) {
    const CloudGround ground(cloud.points, max_range);
    std::vector<SeenPoint> raised;
    std::vector<std::uint32_t> cell_of;
    starts_.assign(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_) + 1, 0);
    for (const Eigen::Vector3f& p : cloud.points) {
      if (!(p.head<2>().norm() < static_cast<float>(max_range))) continue;
      const float height = p.z() - ground.at(p.x(), p.y());
      if (!(height > static_cast<float>(kFoot) && height < static_cast<float>(kLayer * kLayers))) continue;
      raised.push_back({{p.head<2>(), height}, p.z() / p.head<2>().norm()});
      cell_of.push_back(static_cast<std::uint32_t>(cell(index(p.x()), index(p.y()))));
      ++starts_[cell_of.back() + 1];
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    points_.resize(raised.size());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t i = 0; i < raised.size(); ++i) points_[next[cell_of[i]]++] = raised[i];
    masks_.assign(starts_.size() - 1, 0);
    for (std::size_t c = 0; c < masks_.size(); ++c)
      for (std::uint32_t i = starts_[c]; i < starts_[c + 1]; ++i) masks_[c] |= 1U << layer(points_[i].height);
  }

  static int layer(float height) { return static_cast<int>(height / static_cast<float>(kLayer)); }
  int cells() const { return cells_; }
  int index(double metres) const { return static_cast<int>(std::floor(metres / kCell)) + cells_ / 2; }
  std::size_t count(int x, int y) const {
    const std::size_t c = cell(x, y);
    return starts_[c + 1] - starts_[c];
  }
  /// Layers with points in the 3 x 3 cells about a cell.
  int layers(int x, int y) const {
    std::uint32_t all = 0;
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u) all |= masks_[cell(u, v)];
    return std::popcount(all);
  }
  template <class Take>
  void within(const Eigen::Vector2d& at, double radius, const Take& take) const {
    const int x0 = std::max(0, index(at.x() - radius)), x1 = std::min(cells_ - 1, index(at.x() + radius));
    const int y0 = std::max(0, index(at.y() - radius)), y1 = std::min(cells_ - 1, index(at.y() + radius));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const std::size_t c = cell(x, y);
        for (std::uint32_t i = starts_[c]; i < starts_[c + 1]; ++i) {
          const double distance = (points_[i].at.cast<double>() - at).norm();
          if (distance <= radius) take(points_[i], distance);
        }
      }
  }

 private:
  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_) + static_cast<std::size_t>(x);
  }

  int cells_;
  std::vector<std::uint32_t> starts_, masks_;
  std::vector<SeenPoint> points_;
};

/// Cells that are tall and whose neighbours have no more points.
std::vector<Eigen::Vector2d> candidates(const PointGrid& grid) {
  std::vector<Eigen::Vector2d> found;
  for (int y = 1; y + 1 < grid.cells(); ++y)
    for (int x = 1; x + 1 < grid.cells(); ++x) {
      const std::size_t own = grid.count(x, y);
      if (own == 0 || grid.layers(x, y) < kMinCandidateLayers) continue;
      bool is_maximum = true;
      for (int v = y - 1; is_maximum && v <= y + 1; ++v)
        for (int u = x - 1; is_maximum && u <= x + 1; ++u)  // of equal cells the first
          is_maximum = grid.count(u, v) < own + ((v > y || (v == y && u >= x)) ? 1 : 0);
      if (is_maximum)
        found.emplace_back((x - grid.cells() / 2 + 0.5) * kCell, (y - grid.cells() / 2 + 0.5) * kCell);
    }
  return found;
}

Eigen::Vector2d shifted_to_mean(const PointGrid& grid, Eigen::Vector2d at) {
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double count = 0;
    grid.within(at, kCore, [&](const RaisedPoint& p, double) { sum += p.at.cast<double>(), ++count; });
    if (count == 0) break;
    at = sum / count;
  }
  return at;
}

/// Piece of a column in which nothing stands beside it.
struct FreePiece {
  double base = 0, top = 0;
};

FreePiece longest_free_piece(const PointGrid& grid, const Eigen::Vector2d& at, double clear) {
  std::array<int, kLayers> core{}, ring{};
  std::array<float, kLayers> low{}, high{};
  low.fill(1e9F);
  grid.within(at, clear, [&](const RaisedPoint& p, double distance) {
    const auto l = static_cast<std::size_t>(PointGrid::layer(p.height));
    if (distance > kCore) {
      ++ring[l];
      return;
    }
    ++core[l];
    low[l] = std::min(low[l], p.height), high[l] = std::max(high[l], p.height);
  });
  FreePiece best, now;
  bool open = false;
  for (std::size_t l = 0; l < kLayers; ++l) {
    if (core[l] == 0 && ring[l] == 0) continue;  // between the rows of the scanner
    if (core[l] == 0 || ring[l] > kMaxRingFraction * core[l] || (open && low[l] - now.top > kMaxGap)) {
      open = false;
      if (core[l] == 0 || ring[l] > kMaxRingFraction * core[l]) continue;
    }
    if (!open) now.base = low[l];
    open = true;
    now.top = high[l];
    if (now.top - now.base > best.top - best.base) best = now;
  }
  return best;
}

/// Returns the layers of a piece of a column that have points.
std::vector<ColumnLayer> layers_of(const PointGrid& grid, const Eigen::Vector2d& at, const FreePiece& piece) {
  const Eigen::Vector2d along = at.normalized(), across(-along.y(), along.x());
  std::array<std::optional<ColumnLayer>, kLayers> layers;
  grid.within(at, kShape, [&](const SeenPoint& p, double) {
    const auto height = static_cast<double>(p.height), slope = static_cast<double>(p.slope);
    if (height < piece.base || height > piece.top) return;
    const Eigen::Vector2d to = p.at.cast<double>();
    const double off = std::atan2(across.dot(to), along.dot(to));
    std::optional<ColumnLayer>& l = layers[static_cast<std::size_t>(PointGrid::layer(p.height))];
    if (!l) l = {.right = off, .left = off, .low = slope, .high = slope};
    l->right = std::min(l->right, off), l->left = std::max(l->left, off);
    l->low = std::min(l->low, slope), l->high = std::max(l->high, slope);
  });
  std::vector<ColumnLayer> seen;
  for (const std::optional<ColumnLayer>& l : layers)
    if (l) seen.push_back(*l);
  return seen;
}

/// Returns whether a pole is one of a row of columns along the line of sight, as of a wall seen at a flat
/// angle.
bool stands_in_row(const Eigen::Vector2d& at, const std::vector<Eigen::Vector2d>& columns) {
  std::vector<Eigen::Vector2d> to;
  for (const Eigen::Vector2d& column : columns)
    if (const Eigen::Vector2d step = column - at; step.norm() > kCore && step.norm() < kRowReach &&
                                                  std::abs(step.normalized().dot(at.normalized())) > kFlat)
      to.push_back(step.normalized());
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (to[i].dot(to[j]) < kStraight) return true;
  return false;
}

}  // namespace

std::vector<CloudPole> find_poles(const PointCloud& cloud, const CloudPoleOptions& options) {
  const PointGrid grid(cloud, options.max_range + kRowReach);  // what stands behind a pole matters
  std::vector<Eigen::Vector2d> columns = candidates(grid);
  for (Eigen::Vector2d& column : columns) column = shifted_to_mean(grid, column);
  const double step = column_step(cloud);
  const CloudBearings bearings(cloud.points);
  std::vector<CloudPole> poles;
  for (const Eigen::Vector2d& at : columns) {
    if (at.norm() > options.max_range) continue;
    const FreePiece piece = longest_free_piece(grid, at, options.clear);
    if (!(piece.top - piece.base >= options.min_height && piece.base <= options.max_base)) continue;
    std::vector<RaisedPoint> points;
    grid.within(at, kShape, [&](const RaisedPoint& p, double) {
      if (p.height >= static_cast<float>(piece.base) && p.height <= static_cast<float>(piece.top))
        points.push_back(p);
    });
    if (static_cast<int>(points.size()) < options.min_points) continue;
    const std::optional<UprightShape> shape = fit_upright(points, step, options.max_diameter);
    if (!shape || stands_in_row(at, columns)) continue;
    if (cut_off_fraction(layers_of(grid, at, piece), bearings, std::atan2(at.y(), at.x()), at.norm(), step) >
        kMaxCutOff)
      continue;
    const CloudPole pole{.at = shape->axis,
                         .covariance = shape->covariance,
                         .diameter = shape->diameter,
                         .diameter_sd = shape->diameter_sd,
                         .base = piece.base,
                         .top = piece.top,
                         .points = static_cast<int>(points.size())};
    const auto same = std::ranges::find_if(
        poles, [&](const CloudPole& other) { return (other.at - pole.at).norm() < kSame; });
    if (same == poles.end())
      poles.push_back(pole);
    else if (pole.points > same->points)
      *same = pole;
  }
  return poles;
}

}  // namespace waymark::localization

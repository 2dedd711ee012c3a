// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/place_on_dem.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "pipeline/reconstruction/adjustment/level_relief.hpp"
#include "pipeline/reconstruction/adjustment/relief_search.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kTrialsRefined = 60;
constexpr double kMinCellsAcross = 8;  // of the DEM, over the relief: less shows no shape
constexpr double kMinOverlap = 0.8;    // of the points, on the DEM

double median_value(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Least squares of the heights of points above a DEM over the seven parameters of a similarity.
class SurfaceFit {
 public:
  SurfaceFit(const std::vector<Eigen::Vector3d>& points, const CoarseHeights& dem)
      : points_(points), dem_(dem) {}

  /// Refines; returns whether enough points lie on the DEM.
  bool refine(Similarity& map_from_level) {
    for (int iteration = 0; iteration < 40; ++iteration) {
      if (!linearize(map_from_level)) return false;
      const Eigen::Matrix<double, 7, 1> step = normal_.ldlt().solve(right_);
      if (!step.allFinite()) return false;
      apply(map_from_level, step);
      if (step.head<3>().norm() < 1e-4 * dem_.grid.cell && step.tail<4>().norm() < 1e-6) break;
    }
    return linearize(map_from_level);
  }
  double residual() const { return residual_; }
  Eigen::Matrix<double, 7, 7> covariance() const { return normal_.inverse() * variance_; }

 private:
  void apply(Similarity& s, const Eigen::Matrix<double, 7, 1>& step) const {
    const Eigen::Vector3d turn = step.segment<3>(3);
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (turn.norm() > 0) rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    s.rotation = rotation * s.rotation;
    s.scale *= std::exp(step[6]);
    s.shift += step.head<3>();
  }

  // Cauchy weights; the median residual sets their width.
  bool linearize(const Similarity& s) {
    const double d = dem_.grid.cell / 2;
    std::vector<Eigen::Matrix<double, 7, 1>> rows;
    std::vector<double> heights, sizes;
    for (const Eigen::Vector3d& p : points_) {
      const Eigen::Vector3d arm = s.scale * (s.rotation * p), at = arm + s.shift;
      const double here = dem_.at(at.x(), at.y());
      const double east = dem_.at(at.x() + d, at.y()), west = dem_.at(at.x() - d, at.y());
      const double north = dem_.at(at.x(), at.y() + d), south = dem_.at(at.x(), at.y() - d);
      if (!std::isfinite(here + east + west + north + south)) continue;
      const Eigen::Vector3d up(-(east - west) / (2 * d), -(north - south) / (2 * d), 1);
      Eigen::Matrix<double, 7, 1> row;
      row << up, arm.cross(up), up.dot(arm);
      rows.push_back(row);
      heights.push_back(at.z() - here);
      sizes.push_back(std::abs(at.z() - here));
    }
    if (double(rows.size()) < kMinOverlap * double(points_.size()) || rows.size() < kMinReliefNodes)
      return false;
    const double width = 2 * 1.4826 * median_value(sizes) + 1e-9;
    normal_.setZero();
    right_.setZero();
    double squares = 0, total = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double weight = 1 / (1 + std::pow(heights[i] / width, 2));
      normal_ += weight * rows[i] * rows[i].transpose();
      right_ -= weight * heights[i] * rows[i];
      squares += weight * heights[i] * heights[i];
      total += weight;
    }
    variance_ = squares / std::max(1.0, total - 7);
    residual_ = std::sqrt(squares / total);
    return true;
  }

  const std::vector<Eigen::Vector3d>& points_;
  const CoarseHeights& dem_;
  Eigen::Matrix<double, 7, 7> normal_ = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right_ = Eigen::Matrix<double, 7, 1>::Zero();
  double variance_ = 0, residual_ = 0;
};

struct RefinedTrial {
  Similarity map_from_level = {};
  double residual = 0;    // as a fraction of the relief
  double log_chance = 0;  // logarithm of the number of places that fit as well by chance
  Eigen::Matrix<double, 7, 7> covariance;
};

// A random surface of variance s^2 with slopes of variance g^2 has a correlation length of s / g, and an area
// A of it A g^2 / (pi s^2) independent parts. Each of them agrees by chance to a fraction q with a
// probability of about q. Shift, yaw and scale are independent trials when they move the rim by a correlation
// length.
double log_chance_of(const Similarity& map_from_level, const std::vector<Eigen::Vector3d>& nodes,
                     const CoarseHeights& dem, double residual, double scales) {
  std::vector<Eigen::Vector3d> under;
  const double d = dem.grid.cell;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = sum;
  for (const Eigen::Vector3d& node : nodes) {
    const Eigen::Vector3d at = map_from_level * node;
    const Eigen::Vector2d slope((dem.at(at.x() + d, at.y()) - dem.at(at.x() - d, at.y())) / (2 * d),
                                (dem.at(at.x(), at.y() + d) - dem.at(at.x(), at.y() - d)) / (2 * d));
    const double here = dem.at(at.x(), at.y());
    if (!std::isfinite(here) || !slope.allFinite()) continue;
    under.emplace_back(at.x() - map_from_level.shift.x(), at.y() - map_from_level.shift.y(), here);
    sum += slope;
    squares += slope.cwiseAbs2();
  }
  const double count = double(under.size());
  if (under.size() < kMinReliefNodes) return 0;
  const Eigen::Vector3d plane = fitted_plane(under);
  double variance = 0;
  for (const Eigen::Vector3d& p : under)
    variance += std::pow(p.z() - plane.dot(Eigen::Vector3d(p.x(), p.y(), 1)), 2) / count;
  const double slopes = (squares / count - (sum / count).cwiseAbs2()).mean();
  if (!(variance > 0) || !(slopes > 0)) return 0;
  const double length = std::sqrt(variance / slopes), extent = map_from_level.scale;
  const double area = extent * extent * double(nodes.size()) / (kReliefBins * kReliefBins);
  const double rim = std::max(1.0, extent / 2 / length);
  const double trials = std::max(1.0, double(dem.grid.columns * dem.grid.rows) * d * d / (length * length)) *
                        2 * std::numbers::pi * rim * std::max(1.0, scales * rim);
  return std::log(trials) + area / (std::numbers::pi * length * length) * std::log(residual);
}

std::vector<RefinedTrial> refined_trials(const LevelRelief& level, const std::vector<ReliefTrial>& trials,
                                         const CoarseHeights& dem, double scales) {
  std::vector<RefinedTrial> out;
  for (const ReliefTrial& trial : trials) {
    Similarity start{.scale = trial.scale};
    start.rotation = Eigen::AngleAxisd(trial.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    std::vector<double> above;
    for (const Eigen::Vector3d& node : level.nodes) {
      const Eigen::Vector3d at = start * node;
      if (const double h = dem.at(at.x() + trial.x, at.y() + trial.y); std::isfinite(h))
        above.push_back(h - at.z());
    }
    if (above.empty()) continue;
    start.shift = {trial.x, trial.y, median_value(std::move(above))};
    SurfaceFit fit(level.nodes, dem);
    Similarity best = start;
    if (!fit.refine(best) || !(std::abs(std::log(best.scale / start.scale)) < 0.3)) continue;
    if (!(best.rotation(2, 2) > 0.7)) continue;  // 45 degrees off the level
    const double residual = fit.residual() / (best.scale * level.relief);
    out.push_back(
        {best, residual, log_chance_of(best, level.nodes, dem, residual, scales), fit.covariance()});
  }
  std::ranges::stable_sort(out, {}, &RefinedTrial::log_chance);
  return out;
}

// Whether two trials place the relief apart: by an eighth of it, a tenth of its scale or 10 degrees.
bool apart(const Similarity& a, const Similarity& b) {
  const double turn = Eigen::AngleAxisd(a.rotation.transpose() * b.rotation).angle();
  return (a.shift - b.shift).norm() > a.scale / 8 || std::abs(std::log(a.scale / b.scale)) > 0.1 ||
         turn > 10 * std::numbers::pi / 180;
}

Similarity chain(const Similarity& outer, const Similarity& inner) {
  return {outer.scale * inner.scale, outer.rotation * inner.rotation, outer * inner.shift};
}

}  // namespace

DemPlacementResult place_on_dem(const ReliefToPlace& relief, const CoarseHeights& dem,
                                const DemPlacementRules& rules) {
  if (relief.points.size() < kMinReliefNodes || relief.centres.empty())
    return {.message =
                fmt::format("{} tie points are too few to find their place in a DEM", relief.points.size())};
  const LevelRelief level = level_relief(relief);
  if (level.nodes.size() < kMinReliefNodes)
    return {.message = fmt::format("tie points cover {} of {} parts of the area, too few for its relief",
                                   level.nodes.size(), kReliefBins * kReliefBins)};
  if (!(level.relief > 1e-9)) return {.message = "the terrain is flat: no relief can be found in the DEM"};
  const double side = std::max(double(dem.grid.columns), double(dem.grid.rows)) * dem.grid.cell;
  const ReliefSearch search{
      .smallest = std::max({side / rules.max_extents, kMinCellsAcross * dem.grid.cell, rules.smallest}),
      .largest = std::min(side, rules.largest)};
  const auto found = refined_trials(level, search_relief(level.nodes, dem, search, kTrialsRefined), dem,
                                    std::log(search.largest / search.smallest));
  if (found.empty()) return {.message = "the relief of the tie points occurs nowhere in the DEM"};
  const RefinedTrial& best = found.front();
  double other = std::numeric_limits<double>::infinity();
  for (const RefinedTrial& t : found)
    if (t.log_chance < 0 && apart(best.map_from_level, t.map_from_level)) other = std::min(other, t.residual);
  DemPlacement placed{.map_from_frame = chain(best.map_from_level, level.level_from_frame),
                      .covariance = best.covariance,
                      .relief = best.map_from_level.scale * level.relief};
  placed.residual = best.residual * placed.relief;
  placed.next_best_residual = other * placed.relief;
  if (!(best.residual <= rules.max_residual) || !(3 * dem.sd <= placed.relief))
    return {
        .message = fmt::format(
            "the terrain is too flat for the DEM, or is not in it: at the best place the relief is {:.3g} m, "
            "the residuals are {:.3g} m and the heights of the DEM have a standard deviation of {:.3g} m",
            placed.relief, placed.residual, dem.sd)};
  if (!(best.log_chance <= std::log(rules.max_chance)))
    return {
        .message = fmt::format(
            "the relief is too simple to be recognized: {:.2g} places in the DEM are expected to fit as well "
            "by chance (residuals of {:.3g} m for a relief of {:.3g} m)",
            std::exp(std::min(best.log_chance, 700.0)), placed.residual, placed.relief)};
  if (!(placed.next_best_residual >= rules.min_distinction * placed.residual))
    return {.message = fmt::format(
                "the place in the DEM is ambiguous: two places fit with residuals of {:.3g} and {:.3g} m",
                placed.residual, placed.next_best_residual)};
  return {.found = placed};
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/relief_search.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>

namespace waymark::pipeline {
namespace {

constexpr int kYaws = 72;               // steps of 5 degrees move the rim by half a cell
constexpr double kScaleStep = 1.06;     // moves the rim by half a cell, too
constexpr double kCellsAcross = 12;     // of the DEM, over the relief
constexpr std::size_t kKeptPerYaw = 4;  // trials of a yaw and scale

/// Nodes at whole cells of a DEM, with their heights about their plane.
struct Template {
  std::vector<std::int64_t> columns, rows;
  std::vector<std::ptrdiff_t> offsets;
  Eigen::VectorXf heights;                        // about the plane, metres
  Eigen::Matrix<float, Eigen::Dynamic, 3> plane;  // orthonormal: a plane is a combination of the columns
  float squares = 0;
};

Template template_of(const std::vector<Eigen::Vector3d>& nodes, double yaw, double scale, double cell,
                     std::int64_t width) {
  Template out;
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd plane(n, 3);
  Eigen::VectorXd heights(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& p = nodes[static_cast<std::size_t>(i)];
    const double x = scale * (std::cos(yaw) * p.x() - std::sin(yaw) * p.y()),
                 y = scale * (std::sin(yaw) * p.x() + std::cos(yaw) * p.y());
    out.columns.push_back(std::llround(x / cell));
    out.rows.push_back(std::llround(-y / cell));
    out.offsets.push_back(out.rows.back() * width + out.columns.back());
    plane.row(i) << 1, x, y;
    heights[i] = scale * p.z();
  }
  const Eigen::MatrixXd basis =
      Eigen::HouseholderQR<Eigen::MatrixXd>(plane).householderQ() * Eigen::MatrixXd::Identity(n, 3);
  heights -= basis * (basis.transpose() * heights);
  out.plane = basis.cast<float>();
  out.heights = heights.cast<float>();
  out.squares = out.heights.squaredNorm();
  return out;
}

bool better(const ReliefTrial& a, const ReliefTrial& b) {
  return std::tuple(-a.agreement, a.scale, a.yaw, a.y, a.x) <
         std::tuple(-b.agreement, b.scale, b.yaw, b.y, b.x);
}

std::vector<ReliefTrial> best_of_yaw(const Template& trial, const CoarseHeights& dem, double yaw,
                                     double scale) {
  const auto [left, right] = std::ranges::minmax(trial.columns);
  const auto [top, bottom] = std::ranges::minmax(trial.rows);
  const std::int64_t width = dem.grid.columns;
  std::vector<ReliefTrial> kept;
  Eigen::VectorXf seen(trial.heights.size());
  for (std::int64_t r = -top; r + bottom < dem.grid.rows; ++r)
    for (std::int64_t c = -left; c + right < width; ++c) {
      const float* here = dem.heights.cells().data() + r * width + c;
      for (Eigen::Index i = 0; i < seen.size(); ++i)
        seen[i] = here[trial.offsets[static_cast<std::size_t>(i)]];
      seen.array() -= seen[0];  // single precision: heights near 0
      const Eigen::Vector3f level = trial.plane.transpose() * seen;
      const float squares = seen.squaredNorm() - level.squaredNorm();
      const float agreement = 2 * trial.heights.dot(seen) / (squares + trial.squares);
      if (!(agreement > 0) || (kept.size() == kKeptPerYaw && !(agreement > kept.back().agreement))) continue;
      kept.push_back(
          {dem.grid.x(double(c)), dem.grid.y(double(r)), yaw, scale, static_cast<double>(agreement)});
      std::ranges::sort(kept, better);
      if (kept.size() > kKeptPerYaw) kept.pop_back();
    }
  return kept;
}

}  // namespace

std::vector<ReliefTrial> search_relief(const std::vector<Eigen::Vector3d>& nodes, const CoarseHeights& dem,
                                       const ReliefSearch& search, std::size_t count) {
  std::vector<ReliefTrial> all;
  for (double scale = search.largest; scale >= search.smallest && scale > 0; scale /= kScaleStep) {
    const double cell = scale / kCellsAcross;
    const CoarseHeights reduced = with_cell(dem, cell);
    std::vector<std::vector<ReliefTrial>> of_yaws(kYaws);
    tbb::parallel_for(0, kYaws, [&](int k) {
      const double yaw = 2 * std::numbers::pi * k / kYaws;
      of_yaws[static_cast<std::size_t>(k)] = best_of_yaw(
          template_of(nodes, yaw, scale, reduced.grid.cell, reduced.grid.columns), reduced, yaw, scale);
    });
    for (const auto& trials : of_yaws) all.insert(all.end(), trials.begin(), trials.end());
    std::ranges::sort(all, better);
    if (all.size() > count) all.resize(count);
  }
  return all;
}

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/canopy_model.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace waymark::pipeline {
namespace {

constexpr double kHighest = 150;  // metres; returns above are birds and clouds
constexpr double kMaxGap = 8;     // metres, longest edge of the lowest layer

// Ground elevation between cell centres.
double ground_at(const Grid<float>& ground, double column, double row) {
  const auto clamp = [](double v, std::int64_t count) {
    return std::clamp(v, 0.0, static_cast<double>(count - 1));
  };
  const double c = clamp(column, ground.columns()), r = clamp(row, ground.rows());
  const auto i = std::min(static_cast<std::int64_t>(c), std::max<std::int64_t>(0, ground.columns() - 2));
  const auto j = std::min(static_cast<std::int64_t>(r), std::max<std::int64_t>(0, ground.rows() - 2));
  const double u = c - static_cast<double>(i), v = r - static_cast<double>(j);
  const std::int64_t i2 = std::min(i + 1, ground.columns() - 1), j2 = std::min(j + 1, ground.rows() - 1);
  return (1 - v) * ((1 - u) * static_cast<double>(ground(i, j)) + u * static_cast<double>(ground(i2, j))) +
         v * ((1 - u) * static_cast<double>(ground(i, j2)) + u * static_cast<double>(ground(i2, j2)));
}

}  // namespace

CanopyBlock canopy_block(const LaserPoints& points, const CellFrame& frame, double spacing) {
  CanopyBlock block{Grid<float>(frame.columns, frame.rows, std::nanf("")),
                    rasterised_tin(points.ground, frame, 1e9, Beyond::nearest)};
  if (points.ground.empty()) return block;
  // Highest point of each cell, including a margin around the frame.
  const double cell = frame.dx;
  struct Highest {
    double height = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  const std::int64_t margin = 16;
  Grid<Highest> highest(frame.columns + 2 * margin, frame.rows + 2 * margin);
  for (const Eigen::Vector3d& p : points.surface) {
    const double column = (p.x() - frame.x0) / frame.dx, row = (p.y() - frame.y0) / frame.dy;
    const auto c = static_cast<std::int64_t>(std::floor(column + 0.5)) + margin;
    const auto r = static_cast<std::int64_t>(std::floor(row + 0.5)) + margin;
    if (!highest.contains(c, r)) continue;
    const double height = std::max(0.0, p.z() - ground_at(block.ground, column, row));
    Highest& best = highest(c, r);
    const bool replaces =
        height > best.height ||
        (height == best.height && std::tie(p.x(), p.y()) < std::tie(best.point.x(), best.point.y()));
    if (height <= kHighest && replaces) best = {height, {p.x(), p.y(), height}};
  }
  double tallest = 0;
  for (const Highest& h : highest.cells()) tallest = std::max(tallest, h.height);
  std::vector<Eigen::Vector3d> above;
  for (double threshold = 0; threshold <= tallest; threshold += threshold == 0 ? 2 : threshold == 2 ? 3 : 5) {
    above.clear();
    for (const Highest& h : highest.cells())
      if (h.height >= threshold && h.height >= 0) above.push_back(h.point);
    const double longest = threshold == 0 ? kMaxGap : std::max(1.0, 3 * std::max(cell, spacing));
    const Grid<float> layer = rasterised_tin(above, frame, longest, Beyond::nothing);
    for (std::size_t i = 0; i < layer.cells().size(); ++i) {
      float& h = block.heights.cells()[i];
      if (!(h >= layer.cells()[i]) && !std::isnan(layer.cells()[i])) h = layer.cells()[i];
    }
  }
  for (std::int64_t r = 0; r < frame.rows; ++r)  // a TIN passes below the highest point of a cell
    for (std::int64_t c = 0; c < frame.columns; ++c) {
      const double own = highest(c + margin, r + margin).height;
      float& h = block.heights(c, r);
      if (own >= 0 && !(static_cast<double>(h) >= own)) h = static_cast<float>(own);
    }
  return block;
}

}  // namespace waymark::pipeline

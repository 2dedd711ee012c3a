// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "geo/canopy_source.hpp"
namespace waymark::test {

/// Canopy model in memory, cells of `cell` metres on a local plane.
class SyntheticCanopy final : public CanopySource {
 public:
  SyntheticCanopy(Grid<float> heights, double cell = 0.5) : heights_(std::move(heights)) {
    grid_.columns = heights_.columns(), grid_.rows = heights_.rows();
    grid_.where = {Crs::local(), 0, 0, cell, -cell};
  }
  const GridGeometry& geometry() const override { return grid_; }
  const std::string& name() const override { return name_; }
  double ground_elevation(std::int64_t, std::int64_t) const override { return std::nan(""); }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }
  Grid<float> read(const Window& w) const override {
    Grid<float> part(w.columns, w.rows, kNoCanopy);
    for (std::int64_t r = 0; r < w.rows; ++r)
      for (std::int64_t c = 0; c < w.columns; ++c)
        if (heights_.contains(w.column + c, w.row + r)) part(c, r) = heights_(w.column + c, w.row + r);
    return part;
  }
  Window all() const { return {0, 0, grid_.columns, grid_.rows}; }
  const Grid<float>& heights() const { return heights_; }

 private:
  Grid<float> heights_;
  GridGeometry grid_;
  std::string name_ = "made";
};

/// Returns rounded cones with random positions, heights and widths, rough bark, some ground and holes.
inline SyntheticCanopy synthetic_forest(std::uint64_t seed, std::int64_t side, int trees, double cell = 0.5) {
  Random random(seed, "made_forest");
  Grid<float> heights(side, side, 0);
  for (int t = 0; t < trees; ++t) {
    const double x = random.uniform() * static_cast<double>(side),
                 y = random.uniform() * static_cast<double>(side);
    const double top = 4 + 26 * random.uniform(), radius = (0.8 + 0.12 * top) / cell;
    for (std::int64_t r = 0; r < side; ++r)
      for (std::int64_t c = 0; c < side; ++c) {
        const double away = std::hypot(static_cast<double>(c) - x, static_cast<double>(r) - y) / radius;
        if (away < 1)
          heights(c, r) = std::max(heights(c, r), static_cast<float>(top * (1 - 0.7 * away * away)));
      }
  }
  for (float& h : heights.cells()) {
    if (h > 0) h = std::max(0.0F, h + static_cast<float>(1.2 * (random.uniform() - 0.5)));
    if (random.uniform() < 0.002) h = kNoCanopy;
  }
  return {std::move(heights), cell};
}

}  // namespace waymark::test

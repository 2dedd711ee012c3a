// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include "geo/canopy_source.hpp"
#include "pipeline/forest/forest_presets.hpp"
namespace waymark::workflows {

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

/// Canopy with rougher crowns than those of the testbed, and its trees: several leaders per crown, bark and
/// twigs of 1 and 3 m, gaps, understory. Roughness varies between forests.
struct RoughForest {
  SyntheticCanopy canopy;
  Grid<std::int32_t> tree;  ///< tree whose crown covers a cell; -1: ground
};

/// Returns a hectare in cells of 0.5 or 1 m; all parameters are random.
RoughForest rough_forest(std::uint64_t seed, ForestType type);

}  // namespace waymark::workflows

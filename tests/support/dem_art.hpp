// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "geo/dem_handle.hpp"
namespace waymark::test {

/// A DEM in memory: the terrain of most tests.
class MemoryDem final : public DemSource {
 public:
  MemoryDem(Grid<double> heights, Georeference where = {}, NodataPolicy policy = NodataPolicy::ocean,
            bool wraps = false, bool poles = false)
      : heights_(std::move(heights)), policy_(policy) {
    geometry_ = {heights_.columns(), heights_.rows(), where, wraps, poles, poles};
  }
  const GridGeometry& geometry() const override { return geometry_; }
  NodataPolicy nodata_policy() const override { return policy_; }
  HeightWindow read(const Window& window) const override {
    HeightWindow cells(window.columns, window.rows, kNoHeight);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c) {
        std::int64_t column = window.column + c;
        if (geometry_.wraps)
          column = ((column % heights_.columns()) + heights_.columns()) % heights_.columns();
        if (heights_.contains(column, window.row + r)) cells(c, r) = heights_(column, window.row + r);
      }
    return cells;
  }
  std::vector<std::string> files() const override { return {}; }
  const Grid<double>& heights() const { return heights_; }

 private:
  Grid<double> heights_;
  NodataPolicy policy_;
  GridGeometry geometry_;
};

/// Terrain drawn as text: one row per line or "/", "." is no data.
inline Grid<double> dem_art(std::string text) {
  for (char& c : text)
    if (c == '/') c = '\n';
  std::istringstream lines(text);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; cells >> cell;) row.push_back(cell == "." ? kNoHeight : std::stod(cell));
    if (!row.empty()) rows.push_back(std::move(row));
  }
  Grid<double> grid(rows.empty() ? 0 : static_cast<std::int64_t>(rows[0].size()),
                    static_cast<std::int64_t>(rows.size()));
  for (std::int64_t r = 0; r < grid.rows(); ++r)
    for (std::int64_t c = 0; c < grid.columns(); ++c)
      grid(c, r) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
  return grid;
}

/// Nasty random terrain: by seed, plateaus of few levels, smooth hills or noise, with or without voids.
inline Grid<double> random_terrain(unsigned seed, std::int64_t columns, std::int64_t rows) {
  std::mt19937 random(seed);
  const int kind = static_cast<int>(seed % 4);
  std::uniform_int_distribution<int> level(kind == 0 ? 0 : -3, kind == 0 ? 2 : 30);
  std::uniform_real_distribution<double> share(0, 1);
  const double voids = seed % 3 == 0 ? 0.0 : 0.15;
  Grid<double> grid(columns, rows);
  for (double& cell : grid.cells()) cell = level(random);
  if (kind >= 2) {  // smooth, then for kind 2 round to whole metres: flats and ridges
    Grid<double> smooth = grid;
    for (std::int64_t r = 0; r < rows; ++r)
      for (std::int64_t c = 0; c < columns; ++c) {
        double sum = 0;
        int count = 0;
        for (std::int64_t y = r - 1; y <= r + 1; ++y)
          for (std::int64_t x = c - 1; x <= c + 1; ++x)
            if (grid.contains(x, y)) sum += grid(x, y), ++count;
        smooth(c, r) = kind == 2 ? std::floor(sum / count) : sum / count;
      }
    grid = smooth;
  }
  for (double& cell : grid.cells())
    if (share(random) < voids) cell = kNoHeight;
  return grid;
}

}  // namespace waymark::test

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "testbed/forest/plant_forest.hpp"
#include "testbed/laser_return.hpp"
namespace waymark::testbed {

/// Rasters of a survey flight; row 0 is the northernmost. NaN: no return.
struct ForestRasters {
  double x0 = 0, y0 = 0, cell = 0.5;  ///< centre of the first cell, GridFrame
  Grid<float> dsm;                    ///< highest first return
  Grid<float> dtm;                    ///< terrain with correlated errors
  Grid<float> chm;                    ///< dsm - dtm, not below 0
};

/// Simulates an airborne laser scan: vertical pulses, Poisson in every raster cell, up to five returns
/// each. About 1 us per pulse.
/// - A pulse that hits a crown penetrates by an exponential depth and returns there, unless it leaves
///   below. It continues with probability 0.55; the next return is at least 1 m lower, down to the ground.
/// - Cells without a first return take the mean of their neighbours that have one (two rounds), as gridding
///   tools fill pits.
/// - `take` receives the returns by row of cells; null: returns are discarded.
/// Deterministic for the same forest and seed.
ForestRasters scan_forest(const ForestModel& law, const SyntheticForest& forest, const Terrain& terrain,
                          double east, double north, std::uint64_t seed,
                          const std::function<void(std::span<const LaserReturn>)>& take);

/// Returns for each tree the fraction of its crown visible from above: 0 hidden, 1 free.
std::vector<double> visible_crown_fraction(const ForestModel& law, const SyntheticForest& forest,
                                           std::uint64_t seed);

}  // namespace waymark::testbed

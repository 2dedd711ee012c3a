// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>
#include "core/grid.hpp"
#include "testbed/forest/plant_forest.hpp"
namespace waymark {

/// A return of an airborne laser. Metres, GridFrame.
struct LaserReturn {
  double x = 0, y = 0, z = 0;
  std::uint8_t number = 1, of = 1;  ///< return `number` of `of`, from 1
  std::uint8_t kind = 1;  ///< ASPRS class: 2 ground, 3 low (< 2 m), 4 medium (< 5 m), 5 high vegetation
  std::uint16_t intensity = 0;
  double time = 0;  ///< seconds
};

/// The rasters of a flight over the forest; row 0 in the north. No return: NaN.
struct ForestRasters {
  double x0 = 0, y0 = 0, cell = 0.5;  ///< middle of the first cell, GridFrame
  Grid<float> dsm;                    ///< highest first return
  Grid<float> dtm;                    ///< the terrain with smooth errors
  Grid<float> chm;                    ///< dsm - dtm, not below 0
};

/// Flies over the forest: pulses straight down, Poisson in every cell of the raster, up to five returns each.
/// A pulse that meets a crown goes in by an exponential depth and returns there, unless it comes out below;
/// what is left of it goes on with probability 0.55, the next return at least 1 m lower, down to the ground.
/// Cells without a first return take the mean of their neighbours that have one (a second time round where
/// none has), as gridding tools fill single pits. `take` gets the returns row of cells by row of cells, so
/// that they need not be kept; null: nobody wants them. Same returns for the same forest and seed. About 1 us
/// per pulse.
ForestRasters scan_forest(const ForestLaw& law, const MadeForest& forest, const Terrain& terrain, double east,
                          double north, std::uint64_t seed,
                          const std::function<void(std::span<const LaserReturn>)>& take);

/// Of each tree the share of its crown, seen from above, that no other crown stands over: 0 hidden, 1 free.
std::vector<double> seen_from_above(const ForestLaw& law, const MadeForest& forest, std::uint64_t seed);

}  // namespace waymark

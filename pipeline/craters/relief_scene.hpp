// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>
#include "core/grid.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::pipeline {

/// Crater of a catalogue in the cells of a DEM; (0, 0) is the centre of the first cell.
struct CataloguedCrater {
  double column = 0, row = 0;
  double diameter = 0;     ///< cells, north to south
  double depth_ratio = 0;  ///< depth / diameter
};

/// Measured relief whose craters are all known.
struct CrateredRelief {
  Grid<float> heights;              ///< in cells, north to south
  std::vector<double> cell_widths;  ///< per row: width of a cell over its height
  std::vector<CataloguedCrater> craters;
};

/// Craters narrower than this many cells are smoothed by a DEM and count neither way.
inline constexpr double kMinReliefDiameter = 14;
/// Images show one cell on 0.45 to 1 pixels.
inline constexpr double kMinReliefZoom = 0.45;

/// Returns a square image of a window of the relief: at a random position, scale and heading, under a sun 8
/// to 45 degrees high, with mottled albedo, blur, noise and contrast stretch.
/// - Craters of kMinReliefDiameter cells and 12 pixels and more and a depth of 0.03 diameters are clear, as
///   annotators of photographs mark them. Others, and craters cut by the border, have clarity 0.2: detections
///   of them count neither way.
/// - Deterministic for a seed. The relief is at least 1.44 / kMinReliefZoom `side` wide and high.
LabelledScene relief_scene(const CrateredRelief& relief, std::uint64_t seed, int side = 640);

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <vector>
#include "pipeline/reconstruction/surface/surface_grid.hpp"
#include "pipeline/reconstruction/surface/surface_view.hpp"
namespace waymark::pipeline {

/// Mosaic of images on the heights of a DEM.
struct Orthophoto {
  SurfaceGrid grid;            ///< of the pixels
  Grid<float> brightness;      ///< in the units of the images; NaN: none
  Grid<std::uint16_t> source;  ///< index into the views plus 1; 0: none
  std::vector<double> gains;   ///< factor of each view
};

/// Rectifies images on a DEM. Throws Error{input} if an image cannot be read.
/// - Each cell takes the visible view with the least foreshortening and pixels no coarser than needed;
///   visibility is a ray against the DEM.
/// - A cell has `pixels_per_cell` pixels a side. Cells without height stay empty.
/// - Gains level the seams by least squares over the overlaps.
/// - The result depends on neither threads nor memory. `progress` receives parts that add up to 1, from
///   several threads at a time.
Orthophoto make_orthophoto(const std::vector<SurfaceView>& views, const SurfaceGrid& grid,
                           const Grid<float>& heights, int pixels_per_cell, std::size_t image_bytes,
                           const std::function<void(double)>& progress = {});

/// Returns factors near 1 that equalize brightness: log differences between views are adjusted by least
/// squares with a weak pull to 1. `sums(i, j)` adds log(i) - log(j) over `counts(i, j)` points of views i and
/// j.
std::vector<double> balance_gains(const Grid<double>& sums, const Grid<double>& counts);

}  // namespace waymark::pipeline

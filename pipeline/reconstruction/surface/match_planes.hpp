// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <vector>
#include "pipeline/reconstruction/surface/image_levels.hpp"
#include "pipeline/reconstruction/surface/surface_grid.hpp"
namespace waymark::pipeline {

/// Numbers of match_planes().
struct PlaneRules {
  int reach = 4;           ///< of the window, nodes on each side of the middle of the cell
  double width = 2.5;      ///< standard deviation of the weights of the window, nodes
  double slope_sd = 0.5;   ///< expected of the slope that the surface lacks, metres per metre
  double min_texture = 1;  ///< standard deviation of a window over that of the noise
  double max_pixels = 3;   ///< parallax within which images count as linear
};

/// Height of a cell over the surface about which images were compared.
struct PlaneMatch {
  float shift = 0;  ///< metres; NaN: none
  float sd = 0;     ///< formal, for pixels with independent errors; metres
};

/// Heights of the nodes of a rectangle; NaN: no surface.
struct NodeSurface {
  SurfaceGrid grid;  ///< of all nodes
  Window window;
  std::vector<float> heights;

  float at(std::int64_t column, std::int64_t row) const {
    return window.contains(column, row) ? heights[static_cast<std::size_t>(
                                              (row - window.row) * window.columns + column - window.column)]
                                        : std::numeric_limits<float>::quiet_NaN();
  }
};

/// Views that are compared over a rectangle.
struct ComparedViews {
  const std::vector<SurfaceView>& all;
  ImageLevels& images;
  std::span<const std::size_t> used;
  double angle = 0;  ///< largest between two, radians
};

/// Matches height and two slopes of each cell of 2 x 2 nodes over all views at once by least squares (Gruen
/// 1985, with object space as in Helava 1988). One step of Gauss and Newton from the surface; gains and
/// offsets of the views are free, and views that differ from the mean have less weight. Row by row.
std::vector<PlaneMatch> match_planes(const ComparedViews& views, const NodeSurface& surface,
                                     const Window& nodes, const PlaneRules& rules);

}  // namespace waymark::pipeline

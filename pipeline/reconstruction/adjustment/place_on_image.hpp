// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "geo/similarity.hpp"
#include "pipeline/reconstruction/surface/surface_grid.hpp"
namespace waymark::pipeline {

/// Image of level ground: an orthophoto of the map, or a mosaic whose units and axes are unknown.
struct LevelImage {
  SurfaceGrid grid = {};
  Grid<float> brightness = {};  ///< NaN: none
};

/// Position of a mosaic in an orthophoto.
struct ImagePlacement {
  Similarity map_from_mosaic = {};  ///< about the vertical; heights are scaled only
  double score = 0;                 ///< normalized cross-correlation, 1: equal
  double next_best_score = 0;       ///< of the best other placement; 0: none
};

struct ImagePlacementResult {
  std::optional<ImagePlacement> found = {};
  std::string message = {};  ///< why there is none
};

/// Limits of a placement that is accepted.
struct ImagePlacementRules {
  double min_score = 0.15;
  double min_distinction = 1.25;  ///< score of the placement, by that of the next best
  double largest = 1.25;          ///< side of the mosaic, by the longer side of the map
  double smallest = 1.0 / 8;
};

/// Finds shift, yaw and scale that bring a mosaic onto an orthophoto, without a start.
/// - Both are levelled in local brightness and contrast, which takes haze, albedo and gain away.
/// - Correlates 48 x 48 cells of the mosaic at all shifts, yaws of 6 degrees and scales of 8 %. Two fifths of
///   it may be outside the map. The best are refined with 160 x 160 cells to 0.4 % and 0.35 degrees.
/// - Refuses what fits poorly, or another place nearly as well. Relief under another sun looks different.
/// In parallel, the same for any threads; some 20 s for the full range of scales.
ImagePlacementResult place_on_image(const LevelImage& mosaic, const LevelImage& map,
                                    const ImagePlacementRules& rules = {});

}  // namespace waymark::pipeline

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
#include "pipeline/reconstruction/surface/image_levels.hpp"
namespace waymark::pipeline {

/// How points of an orthophoto are searched in images.
struct MapImageMatching {
  int across = 14;            ///< points along the longer side of the ground that the images cover
  int half = 12;              ///< of a pattern, cells of the map on each side of its middle
  int reach = 10;             ///< of the search, cells of the map
  double min_score = 0.45;    ///< normalized cross-correlation
  std::size_t max_views = 6;  ///< images per point: those whose pixels are closest to the map's cells
  double agreement = 2.5;     ///< of shifts with their affine trend, cells of the map
};

/// Patterns of the map that images show.
struct MapImageControl {
  std::vector<ControlPoint> points = {};  ///< `position` and `sd` in x, y; z is the ground, its sd is 0
  std::size_t tried = 0, matched = 0, agreeing = 0;  ///< pairs of point and image
};

/// Measures where images show points of an orthophoto.
/// - Each image is rectified about a point on `ground`, at the cells of the map, and correlated with the map.
/// - Of the maxima, those whose shifts follow one affine trend become marks, with a deviation of a third of a
///   cell; the map's own position has one of half a cell. No points if less than half of them do.
/// - `views[i]` is image `image_of_view[i]` of the reconstruction. In parallel over points.
MapImageControl control_of_map_image(const LevelImage& map, const CoarseHeights& ground,
                                     const std::vector<SurfaceView>& views,
                                     const std::vector<std::size_t>& image_of_view, ImageLevels& images,
                                     const MapImageMatching& matching = {});

}  // namespace waymark::pipeline

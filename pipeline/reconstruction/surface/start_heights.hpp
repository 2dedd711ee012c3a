// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>
#include "pipeline/reconstruction/surface/image_levels.hpp"
#include "pipeline/reconstruction/surface/surface_grid.hpp"
namespace waymark::pipeline {

/// Heights between which the terrain lies, metres.
struct HeightRange {
  double low = 0, high = 0;
};

/// Returns the range of tie points, robust against 2 % of wrong ones on each side, and a quarter more;
/// `std::nullopt` for fewer than 10 points.
std::optional<HeightRange> height_range(std::span<const Eigen::Vector3d> points);

/// Measures heights along the rays of a grid of pixels in small images: the depth at which level patches
/// correlate best with the images of the nearest cameras. Searches depths of 1/3 to 20 baselines, uniformly
/// in inverse depth. Points so few or so scattered that chance explains them are no result.
std::vector<Eigen::Vector3d> probe_heights(const std::vector<SurfaceView>& views, ImageLevels& images);

/// Returns the grid of the terrain that two or more views see between two heights, aligned to multiples of
/// the cell; `std::nullopt` if there is none. Rays flatter than 10 degrees do not count.
std::optional<SurfaceGrid> overlap_grid(const std::vector<SurfaceView>& views, const HeightRange& range,
                                        double cell);

/// Returns the ground sample distance that four fifths of the images reach at their middles, on level terrain
/// of a height, metres; 0 if no image sees it.
double usual_gsd(const std::vector<SurfaceView>& views, double height);

}  // namespace waymark::pipeline

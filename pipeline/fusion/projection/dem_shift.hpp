// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

struct DemShiftRules {
  int fine_radius = 6;              ///< cells of the high-pass filter: window of 2 fine_radius + 1
  int max_cells_of_shift = 16;      ///< search radius, cells
  int peak_radius = 5;              ///< cells around the maximum that are not background
  double min_correlation = 0.15;    ///< of brightness and shading at the maximum
  double min_significance = 8;      ///< maximum over the standard deviation of the background
  double min_lead = 4;              ///< the same for the difference to the second maximum
  std::int64_t max_cells = 60'000;  ///< larger areas use coarser cells
  double min_known = 400;           ///< fewest cells that are compared
};

/// Measures by how much the relief in an image lies beside that of the DEM: the brightness of the ground is
/// correlated with the DEM's shading over all shifts in plan (normalised cross-correlation).
/// - The search does not use the stated uncertainty of the pose, so errors far beyond it are seen.
/// - The covariance follows from the gradients of the correlation away from its maximum.
/// - A shift caused by the DEM and one caused by the pose look the same.
/// `std::nullopt` without pose or sun, or if the maximum is not significant. Cost: (2 max_cells_of_shift +
/// 1)^2 times the cells.
std::optional<DemShift> measure_dem_shift(const Pixels& pixels, const ImageView& image,
                                          const Terrain& terrain, double metres_per_unit,
                                          const DemShiftRules& rules = {});

struct CommonShiftRules {
  int min_images = 2;
  double min_fraction = 0.5;  ///< of the images with a camera that show a significant shift
  double gate = 3;            ///< standard deviations that a shift has to exceed
  double sd_of_cell = 0.25;   ///< systematic error of a measured shift, in cells
};

/// Shift that the images of a map have in common.
struct CommonShift {
  Eigen::Vector2d metres = Eigen::Vector2d::Zero();  ///< east, north: images minus DEM
  double sd = 0;                                     ///< of its length, metres
  double stated_sd = 0;  ///< that the stated poses give a point on the ground, metres
  int measured = 0;      ///< images with a shift
  bool significant = false;
};

/// Returns the median of ImageView::dem_shift over the images, and whether it contradicts the stated poses.
/// `std::nullopt` if too few images have one.
std::optional<CommonShift> common_dem_shift(std::span<const ImageView> images,
                                            const CommonShiftRules& rules = {});

}  // namespace waymark::pipeline

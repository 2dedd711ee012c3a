// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <vector>
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
#include "pipeline/reconstruction/surface/surface_view.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

inline constexpr std::size_t kViewBytes = std::size_t{1} << 29;  ///< of pixels that are held for views

/// Posed images of a reconstruction as views, and which image each is.
struct SceneViews {
  std::vector<pipeline::SurfaceView> views = {};
  std::vector<std::size_t> images = {};  ///< indices into `Reconstruction::images`
};
SceneViews views_of(const pipeline::Reconstruction& scene, const Photos& photos);

/// Returns the ground that the tie points of a level scene show: medians in 48 x 48 cells, gaps filled.
pipeline::CoarseHeights ground_of(const pipeline::Reconstruction& scene);

/// Returns a mosaic of 160 x 160 cells in the units of a level scene; NaN where no image shows the ground
/// from more than 44 degrees above the horizon. Throws Error{input} for an image that cannot be read.
pipeline::LevelImage level_mosaic(const pipeline::Reconstruction& scene, const Photos& photos);

}  // namespace waymark::workflows

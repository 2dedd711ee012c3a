// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Returns per image 1 plus its fractions of footprint (by bounding boxes) in each other image with
/// ImageView::dem_constraint.
/// Errors of the DEM are common to these images, so their constraints are not independent.
std::vector<double> shared_footprints(std::span<const ImageView> images);

}  // namespace waymark::pipeline

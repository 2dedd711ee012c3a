// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// Per image: itself, and of each other image that told its place by the ground (ImageView::on_ground) the
/// share of this one's footprint that lies in the other's, by their bounding boxes. Where a DEM errs, all of
/// them err alike, so many know little more than one.
std::vector<double> shared_ground(std::span<const ImageView> images);

}  // namespace waymark

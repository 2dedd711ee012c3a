// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Returns the view described by an image header, without footprint, area and ground sample distance.
/// Throws Error{input} for an image without pose and georeference, with a geographic CRS, or with a camera of
/// another size.
ImageView make_image_view(const ImageInfo& info);

/// Computes footprint, area and ground sample distance; footprints in units of a CRS of `metres_per_unit`.
void compute_footprint(ImageView& image, const Terrain& terrain, double metres_per_unit);

}  // namespace waymark::pipeline

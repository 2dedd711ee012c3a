// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
#include "pipeline/fusion/image_view.hpp"
namespace waymark {

/// What an image looks at, as far as its header tells: footprint, area and ground sample distance are left
/// open. Throws Error{input} for an image without pose and georeference, one in degrees, and one whose
/// camera is of another size than its pixels.
ImageView image_view_of(const ImageInfo& info);

/// Fills in footprint, area and ground sample distance; footprints in units of a CRS of `metres_per_unit`.
void lay_out(ImageView& image, const class Terrain& terrain, double metres_per_unit);

}  // namespace waymark

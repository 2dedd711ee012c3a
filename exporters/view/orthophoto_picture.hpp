// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "exporters/report/relief_picture.hpp"
#include "exporters/report/relief_source.hpp"
namespace waymark::exporters {

/// A part of an orthophoto for display.
struct OrthophotoPicture {
  Extent extent;        ///< CRS of the map
  Grid<Colour> pixels;  ///< row 0 in the north; alpha 0: no pixel
};

/// Reads the part of an orthophoto within `within`, averaged so that the longer side has at most `longest`
/// pixels, and stretches its contrast. `near_x` as in read_relief().
/// Throws Error{input} for a file that is no image, is not georeferenced or rotated, is of another CRS, or
/// does not overlap `within`.
OrthophotoPicture read_orthophoto(const std::string& path, const Crs& crs, double near_x,
                                  const Extent& within, std::int64_t longest);

}  // namespace waymark::exporters

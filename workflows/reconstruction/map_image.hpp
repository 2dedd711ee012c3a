// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "geo/crs.hpp"
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"
namespace waymark::workflows {

/// Orthophoto of a site in the grid frame of a CRS.
struct MapImage {
  Crs crs = Crs::local();
  pipeline::LevelImage image = {};
  std::vector<std::string> messages = {};  ///< how the file was changed: reduced, projected
};

/// Reads an orthophoto and resamples it to `crs`.
/// - Empty: its own CRS, or a local projection about its middle if lengths in its own are wrong by 0.2 %.
/// - Files above 36 megapixels are reduced by a whole number.
/// - Throws Error{input} for an image without a georeference or in degrees, Error{usage} for a `crs` in
/// degrees.
MapImage read_map_image(const std::string& file, const std::string& crs);

/// Throws what read_map_image() would throw for the file and the CRS, without reading pixels.
void check_map_image(const std::string& file, const std::string& crs);

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "importers/rasters/dem.hpp"
namespace waymark {

/// A DEM in degrees as one in metres, for cameras: transverse Mercator about its middle, cells as fine as the
/// finer side of its own there, heights between them interpolated linearly. A cell beside one without height
/// has none either. Lazy: cells are transformed as they are read, about 1 us each. A DEM in metres is passed
/// through. Throws Error{input} for one wider than 6 degrees on the ground: no plane is true to it.
std::shared_ptr<const ImportedDem> in_metres(std::shared_ptr<const ImportedDem> dem);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "importers/rasters/dem.hpp"
namespace waymark::importers {

/// Projects a DEM in degrees to metres, for cameras: transverse Mercator about its middle, with cells as fine
/// as the finer side of its own there.
/// - Heights between cells are interpolated linearly; a cell beside one without height has none either.
/// - Cells are transformed when read, about 1 us each.
/// - A DEM in metres is returned unchanged.
/// Throws Error{input} for a DEM wider than 6 degrees on the ground, beyond which the scale error exceeds 0.2
/// %.
std::shared_ptr<const ImportedDem> project_to_metres(std::shared_ptr<const ImportedDem> dem);

}  // namespace waymark::importers

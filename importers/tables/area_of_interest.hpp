// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geo/area.hpp"
#include "geo/crs.hpp"
namespace waymark::importers {

/// Reads all polygons of a vector file, of every layer, as one area in the CRS `into`. Long edges are divided
/// before they are transformed. A layer without a CRS is taken to be in `into`; if `into` is local, every
/// layer is. Throws Error{input} if there is no such file or it holds no polygon, and for another body.
Area read_area_of_interest(const std::string& path, const Crs& into);

}  // namespace waymark::importers

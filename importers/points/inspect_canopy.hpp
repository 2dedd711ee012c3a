// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "geo/canopy_source.hpp"
namespace waymark::importers {

/// Returns heights as in the rasters, negative and absurd ones included; kNoCanopy if unknown.
using CanopyReader = std::function<Grid<float>(const Window&)>;

/// Checks squares spread over a canopy model. Throws Error{input} if most of it cannot be heights above
/// ground: elevations, or a terrain above its surface. Returns warnings on holes, negative heights and
/// heights of no tree. `terrain` is the file of the terrain model, empty for a canopy height model.
std::vector<std::string> inspect_canopy(const CanopySource& canopy, const std::string& terrain,
                                        const std::string& file, const CanopyReader& read);

}  // namespace waymark::importers

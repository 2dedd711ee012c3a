// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "geo/canopy_source.hpp"
namespace waymark {

/// Heights as the rasters have them, negative and absurd ones included; kNoCanopy where unknown.
using CanopyReader = std::function<Grid<float>(const Window&)>;

/// Looks at squares spread over a canopy model. Throws Error{input} where most of it cannot be heights above
/// ground: elevations, or a terrain above its surface. Returns warnings on the rest: holes, negative heights,
/// heights of no tree. `terrain` is the file of the terrain model, empty for a canopy height model.
std::vector<std::string> inspect_canopy(const CanopySource& canopy, const std::string& terrain,
                                        const std::string& file, const CanopyReader& read);

}  // namespace waymark

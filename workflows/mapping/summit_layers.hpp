// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/map_contents.hpp"
namespace waymark::workflows {

/// Returns the layers `saddle` and `parent_line` of landmarks with a key saddle; a layer without a row is
/// left out.
/// - Rows are in the order of their landmarks in the map, so they do not depend on the division into parts.
/// - Reads the parts four times. Keeps 24 bytes per summit, and a copy of the summits that are not in parts.
std::vector<geodb::ShapeLayer> summit_layers(const geodb::MapContents& contents);

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/shape_layer.hpp"
#include "pipeline/buildings/building_outline.hpp"
namespace waymark::workflows {

/// Returns the layer `footprint`: the outlines of buildings, ordered along a Hilbert curve.
geodb::ShapeLayer footprint_layer(std::vector<pipeline::BuildingOutline> footprints);

}  // namespace waymark::workflows

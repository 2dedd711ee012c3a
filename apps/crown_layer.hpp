// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/crown_shape.hpp"
namespace waymark {

/// The layer `crown`: a polygon per tree with its uid, height, area and diameter.
ShapeLayer crown_layer(std::span<const CrownShape> crowns);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "geodb/shape_layer.hpp"
namespace waymark::workflows {

/// Adds a layer. Rows that a layer of the same name has already are left out. A layer with other columns or
/// geometries gets the suffix "_2", "_3", ...
void add_layer(std::vector<geodb::ShapeLayer>& layers, geodb::ShapeLayer layer);

}  // namespace waymark::workflows

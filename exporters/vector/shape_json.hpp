// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "geodb/shape_layer.hpp"
namespace waymark::exporters {

/// Returns the attributes of a layer as a JSON array of one object per row, members in the order of the
/// columns. NULL and numbers that are not finite are null. Geometries are left out.
std::string layer_to_json(const geodb::ShapeLayer& layer);

}  // namespace waymark::exporters

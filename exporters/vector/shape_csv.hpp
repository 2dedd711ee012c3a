// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "geodb/shape_layer.hpp"
namespace waymark::exporters {

/// Returns the attributes of a layer as CSV: a line of column names, then one line per row. Numbers have up
/// to ten digits; NULL and numbers that are not finite are empty; texts are quoted as in RFC 4180. Geometries
/// are left out.
std::string layer_to_csv(const geodb::ShapeLayer& layer);

}  // namespace waymark::exporters

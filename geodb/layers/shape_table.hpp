// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
#include "geodb/sqlite/sqlite.hpp"
namespace waymark::geodb {

/// Returns the shape layers of an open map from its table `waymark_layer`: sorted names, kinds and summaries,
/// without rows.
std::vector<ShapeLayer> declared_layers(const sqlite::Database& database);

/// Returns "POINT", "MULTILINESTRING" or "MULTIPOLYGON".
const char* geometry_name(ShapeKind kind);

/// Return the style documents of QGIS 3 (QML) and OGC (SLD 1.1).
std::string qml_shape_style(const ShapeLayer& layer);
std::string sld_shape_style(const ShapeLayer& layer);

}  // namespace waymark::geodb

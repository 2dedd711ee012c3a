// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "geodb/shape_layer.hpp"
namespace waymark {

/// The attributes of a layer as a text table: a line of column names, then one line per row. Numbers are
/// written with up to ten digits, nothing for NULL and for numbers that are not finite; texts are quoted
/// where RFC 4180 asks for it. Geometries are left out.
std::string as_csv(const ShapeLayer& layer);

}  // namespace waymark

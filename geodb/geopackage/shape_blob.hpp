// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/shape_layer.hpp"
namespace waymark::geodb {

/// Returns the geometry of a shape, little-endian: POINT, or MULTILINESTRING and MULTIPOLYGON with envelope.
/// Outer rings are counter-clockwise, holes clockwise, all closed. Without parts the geometry is empty.
std::vector<std::byte> shape_blob(ShapeKind kind, std::span<const ShapePart> parts, std::int32_t srs_id);

/// Returns the parts of a geometry of any type; empty if the bytes are not a geometry.
std::vector<ShapePart> parts_of(std::span<const std::byte> blob);

Envelope envelope_of(std::span<const ShapePart> parts);

}  // namespace waymark::geodb

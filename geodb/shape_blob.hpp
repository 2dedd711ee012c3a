// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
#include "geodb/geometry_blob.hpp"
#include "geodb/shape_layer.hpp"
namespace waymark {

/// The geometry of a shape, little-endian, with its envelope: POINT, MULTILINESTRING or MULTIPOLYGON (outer
/// rings counter-clockwise, holes clockwise, all closed). Without parts an empty geometry.
std::vector<std::byte> shape_blob(ShapeKind kind, std::span<const ShapePart> parts, std::int32_t srs_id);

/// The parts of a geometry of any kind; empty where the bytes are none.
std::vector<ShapePart> parts_of(std::span<const std::byte> blob);

Envelope envelope_of(std::span<const ShapePart> parts);

}  // namespace waymark

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/attribute.hpp"
namespace waymark::exporters {

/// Appends a property to a list of properties: the number of its key, and the value as a vector tile stores
/// it, reals as 32-bit floats. Appends nothing for an unknown value.
void append_property(std::string& properties, std::uint32_t key, const AttributeValue& value);
/// Appends a real; `exact`: with 64 bits. Appends nothing for NaN.
void append_real(std::string& properties, std::uint32_t key, double value, bool exact = false);

/// Point of a layer.
struct TilePoint {
  std::uint64_t id = 0;                           ///< below 2^53, so that JavaScript keeps it
  std::uint32_t x = 0, y = 0;                     ///< in [0, VectorLayer::kExtent), y down
  std::vector<std::string_view> properties = {};  ///< lists of append_property
};

/// Polygon of a layer.
struct TilePolygon {
  using Ring = std::vector<std::array<std::int32_t, 2>>;  ///< steps, y down; not closed
  std::uint64_t id = 0;                                   ///< below 2^53
  /// Outer rings turn from x to y, as the specification asks; holes follow their outer ring and turn back.
  std::vector<Ring> rings = {};
  std::vector<std::string_view> properties = {};  ///< lists of append_property
};

/// Layer of a tile.
struct VectorLayer {
  static constexpr std::uint32_t kExtent = 4096;  ///< steps per side of a tile
  std::string_view name;
  std::span<const std::string> keys;
  std::vector<TilePoint> points = {};
  std::vector<TilePolygon> polygons = {};
};

/// Encodes layers as a Mapbox Vector Tile 2.1, not compressed. Keys and values that no feature of the tile
/// has are left out; layers without features, too.
std::string encode_vector_tile(std::span<const VectorLayer> layers);

}  // namespace waymark::exporters

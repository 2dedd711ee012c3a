// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/vector_tile.hpp"

#include <cmath>
#include <cstring>
#include <unordered_map>

#include "exporters/web/varint.hpp"

namespace waymark::exporters {
namespace {

enum Wire : std::uint32_t { varint = 0, fixed64 = 1, bytes = 2, fixed32 = 5 };

void append_tag(std::string& message, std::uint32_t field, Wire wire) {
  append_varint(message, field << 3 | wire);
}

void append_number(std::string& message, std::uint32_t field, std::uint64_t value) {
  append_tag(message, field, varint);
  append_varint(message, value);
}

void append_bytes(std::string& message, std::uint32_t field, std::string_view value) {
  append_tag(message, field, bytes);
  append_varint(message, value.size());
  message.append(value);
}

template <class T>
void append_plain(std::string& message, std::uint32_t field, Wire wire, T value) {
  append_tag(message, field, wire);
  char plain[sizeof value];
  std::memcpy(plain, &value, sizeof value);  // both are little-endian
  message.append(plain, sizeof value);
}

/// Message `Value` of vector_tile.proto; empty for an unknown value.
struct ValueMessage {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(const std::string& text) const {
    std::string message;
    append_bytes(message, 1, text);
    return message;
  }
  std::string operator()(double value) const {
    std::string message;
    if (!std::isnan(value)) append_plain(message, 2, fixed32, static_cast<float>(value));
    return message;
  }
  std::string operator()(std::int64_t value) const {
    std::string message;
    append_number(message, 6, zigzag(value));
    return message;
  }
};

void append_message(std::string& properties, std::uint32_t key, std::string_view message) {
  if (message.empty()) return;
  append_varint(properties, key);
  append_varint(properties, message.size());
  properties += message;
}

std::uint64_t take_varint(std::string_view& from) {
  std::uint64_t value = 0;
  for (int shift = 0;; shift += 7) {
    const auto byte = static_cast<unsigned char>(from.front());
    from.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
}

/// Numbers of the keys or values of a layer, in order of first use.
template <class Key>
class Numbering {
 public:
  std::uint64_t operator()(Key key) {
    const auto [found, is_new] = numbers_.try_emplace(key, numbers_.size());
    if (is_new) used_.push_back(key);
    return found->second;
  }
  const std::vector<Key>& used() const { return used_; }

 private:
  std::unordered_map<Key, std::uint64_t> numbers_;
  std::vector<Key> used_;
};

class LayerWriter {
 public:
  std::string features = {};
  Numbering<std::uint64_t> keys = {};
  Numbering<std::string_view> values = {};

  void add(const TilePoint& point) {
    std::string geometry;
    append_varint(geometry, kMoveToOnce);
    append_varint(geometry, zigzag(point.x));
    append_varint(geometry, zigzag(point.y));
    add_feature(point.id, kPoint, geometry, point.properties);
  }

  void add(const TilePolygon& polygon) {
    std::string geometry;
    std::array<std::int32_t, 2> at{0, 0};
    const auto move = [&](const std::array<std::int32_t, 2>& to) {
      for (std::size_t axis = 0; axis < 2; ++axis)
        append_varint(geometry, zigzag(std::int64_t{to[axis]} - at[axis]));
      at = to;
    };
    for (const TilePolygon::Ring& ring : polygon.rings) {
      append_varint(geometry, kMoveToOnce);
      move(ring.front());
      append_varint(geometry, (ring.size() - 1) << 3 | 2);  // LineTo
      for (std::size_t i = 1; i < ring.size(); ++i) move(ring[i]);
      append_varint(geometry, 1 << 3 | 7);  // ClosePath
    }
    add_feature(polygon.id, kPolygon, geometry, polygon.properties);
  }

 private:
  static constexpr std::uint64_t kMoveToOnce = 1 << 3 | 1, kPoint = 1, kPolygon = 3;

  void add_feature(std::uint64_t id, std::uint64_t kind, const std::string& geometry,
                   const std::vector<std::string_view>& properties) {
    std::string tags;
    for (std::string_view list : properties)
      while (!list.empty()) {
        append_varint(tags, keys(take_varint(list)));
        const std::uint64_t size = take_varint(list);
        append_varint(tags, values(list.substr(0, size)));
        list.remove_prefix(size);
      }
    std::string feature;
    append_number(feature, 1, id);
    append_bytes(feature, 2, tags);
    append_number(feature, 3, kind);
    append_bytes(feature, 4, geometry);
    append_bytes(features, 2, feature);
  }
};

}  // namespace

void append_property(std::string& properties, std::uint32_t key, const AttributeValue& value) {
  append_message(properties, key, std::visit(ValueMessage{}, value));
}

void append_real(std::string& properties, std::uint32_t key, double value, bool exact) {
  std::string message;
  if (exact && !std::isnan(value))
    append_plain(message, 3, fixed64, value);
  else
    message = ValueMessage{}(value);
  append_message(properties, key, message);
}

std::string encode_vector_tile(std::span<const VectorLayer> layers) {
  std::string tile;
  for (const VectorLayer& layer : layers) {
    if (layer.points.empty() && layer.polygons.empty()) continue;
    LayerWriter writer;
    for (const TilePoint& point : layer.points) writer.add(point);
    for (const TilePolygon& polygon : layer.polygons) writer.add(polygon);
    std::string message;
    append_number(message, 15, 2);  // version
    append_bytes(message, 1, layer.name);
    message += writer.features;
    for (const std::uint64_t key : writer.keys.used()) append_bytes(message, 3, layer.keys[key]);
    for (const std::string_view value : writer.values.used()) append_bytes(message, 4, value);
    append_number(message, 5, VectorLayer::kExtent);
    append_bytes(tile, 3, message);
  }
  return tile;
}

}  // namespace waymark::exporters

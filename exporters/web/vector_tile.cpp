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

struct LayerWriter {
  std::string features = {};
  Numbering<std::uint64_t> keys = {};
  Numbering<std::string_view> values = {};

  void add(const TilePoint& point) {
    std::string tags;
    for (std::string_view list : point.properties)
      while (!list.empty()) {
        append_varint(tags, keys(take_varint(list)));
        const std::uint64_t size = take_varint(list);
        append_varint(tags, values(list.substr(0, size)));
        list.remove_prefix(size);
      }
    std::string geometry;
    constexpr std::uint64_t move_to_once = 1 << 3 | 1;
    append_varint(geometry, move_to_once);
    append_varint(geometry, zigzag(point.x));
    append_varint(geometry, zigzag(point.y));
    std::string feature;
    append_number(feature, 1, point.id);
    append_bytes(feature, 2, tags);
    append_number(feature, 3, 1);  // POINT
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
    if (layer.points.empty()) continue;
    LayerWriter writer;
    for (const TilePoint& point : layer.points) writer.add(point);
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

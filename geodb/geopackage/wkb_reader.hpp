// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
namespace waymark::geodb::wkb {

/// Reader of GeoPackage geometries of any type and byte order; private to geodb.

inline constexpr std::uint32_t kPoint = 1, kLine = 2, kPolygon = 3, kMultiLine = 5, kMultiPolygon = 6,
                               kCollection = 7;
inline constexpr std::size_t kEnvelopeSize[] = {0, 32, 48, 48, 64};  // by the envelope code of the flags

/// Sequential reader; each read past the end clears ok().
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}
  bool ok() const { return ok_; }
  void fail() { ok_ = false; }
  std::size_t left() const { return rest_.size(); }
  void set_byte_order(bool little) { swap_ = !little; }
  void skip(std::size_t count) {
    if (count > rest_.size()) return fail();
    rest_ = rest_.subspan(count);
  }
  template <class T>
  T next() {
    std::array<std::byte, sizeof(T)> raw{};
    if (rest_.size() < raw.size()) {
      fail();
      return T{};
    }
    std::copy_n(rest_.begin(), raw.size(), raw.begin());
    rest_ = rest_.subspan(raw.size());
    if (swap_) std::ranges::reverse(raw);
    return std::bit_cast<T>(raw);
  }

 private:
  std::span<const std::byte> rest_;
  bool ok_ = true, swap_ = false;
};

struct GeometryHeader {
  std::int32_t srs_id = 0;
  std::size_t size = 0;
};

inline std::optional<GeometryHeader> header_of(std::span<const std::byte> blob) {
  Cursor cursor(blob);
  const bool magic = cursor.next<char>() == 'G' && cursor.next<char>() == 'P';
  cursor.skip(1);
  const auto flags = cursor.next<std::uint8_t>();
  const unsigned code = flags >> 1 & 7;
  cursor.set_byte_order(flags & 1);
  const auto srs_id = cursor.next<std::int32_t>();
  if (!cursor.ok() || !magic || code >= std::size(kEnvelopeSize)) return std::nullopt;
  cursor.skip(kEnvelopeSize[code]);
  if (!cursor.ok()) return std::nullopt;
  return GeometryHeader{srs_id, 8 + kEnvelopeSize[code]};
}

struct WkbType {
  std::uint32_t kind = 0;  ///< 1 point .. 7 collection
  std::size_t axes = 2;
  bool z = false;
};

inline WkbType next_type(Cursor& wkb) {
  wkb.set_byte_order(wkb.next<std::uint8_t>() == 1);
  const auto code = wkb.next<std::uint32_t>();
  const std::uint32_t dimension = code / 1000;
  if (code % 1000 < kPoint || code % 1000 > kCollection || dimension > 3) wkb.fail();
  return {code % 1000, dimension == 0 ? 2u : dimension == 3 ? 4u : 3u, dimension == 1 || dimension == 3};
}

/// Calls `visit(x, y, z)` for every vertex, and `start(kind, ring)` before each point, line and ring of a
/// polygon; `ring` counts from 0, the outer one.
void walk(Cursor& wkb, const auto& visit, const auto& start, int depth = 0) {
  const WkbType type = next_type(wkb);
  if (depth > 8) wkb.fail();
  const auto vertices = [&](std::uint32_t count) {
    if (count > wkb.left() / (8 * type.axes)) wkb.fail();
    for (std::uint32_t i = 0; i < count && wkb.ok(); ++i) {
      std::array<double, 4> v{};
      for (std::size_t axis = 0; axis < type.axes; ++axis) v[axis] = wkb.next<double>();
      visit(v[0], v[1], type.z ? v[2] : 0.0);
    }
  };
  if (!wkb.ok()) return;
  if (type.kind < kPolygon) start(type.kind, 0u);
  if (type.kind == kPoint) return vertices(1);
  const auto count = wkb.next<std::uint32_t>();
  if (type.kind < kPolygon) return vertices(count);
  for (std::uint32_t i = 0; i < count && wkb.ok(); ++i) {
    if (type.kind == kPolygon) {
      start(type.kind, i);
      vertices(wkb.next<std::uint32_t>());
    } else {
      walk(wkb, visit, start, depth + 1);
    }
  }
}

inline std::optional<std::span<const std::byte>> wkb_of(std::span<const std::byte> blob) {
  const auto header = header_of(blob);
  if (!header) return std::nullopt;
  return blob.subspan(header->size);
}

}  // namespace waymark::geodb::wkb

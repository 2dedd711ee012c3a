// SPDX-License-Identifier: Apache-2.0
#include "geodb/geometry_blob.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace waymark {
namespace {

static_assert(std::endian::native == std::endian::little, "blobs are written as they lie in memory");

constexpr std::uint32_t kPoint = 1, kPolygon = 3, kMultiPolygon = 6, kCollection = 7;
constexpr std::uint32_t kWithZ = 1000;
constexpr std::size_t kEnvelopeSize[] = {0, 32, 48, 48, 64};  // by the envelope code of the flags

template <class T>
std::byte* put(std::byte* at, T value) {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
  bytes.resize(bytes.size() + sizeof value);
  put(bytes.data() + bytes.size() - sizeof value, value);
}

void append_header(std::vector<std::byte>& bytes, int envelope_code, bool empty, std::int32_t srs_id) {
  for (const int byte : {int{'G'}, int{'P'}, 0, 1 | envelope_code << 1 | int{empty} << 4})
    bytes.push_back(static_cast<std::byte>(byte));
  append(bytes, srs_id);
}

void append_wkb_start(std::vector<std::byte>& bytes, std::uint32_t type, std::size_t count) {
  append(bytes, std::uint8_t{1});
  append(bytes, type);
  append(bytes, static_cast<std::uint32_t>(count));
}

/// Reads on from the front; every read past the end clears ok().
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

struct Header {
  std::int32_t srs_id = 0;
  std::size_t size = 0;
};

std::optional<Header> header_of(std::span<const std::byte> blob) {
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
  return Header{srs_id, 8 + kEnvelopeSize[code]};
}

struct WkbType {
  std::uint32_t kind = 0;  ///< 1 point .. 7 collection
  std::size_t axes = 2;
  bool z = false;
};

WkbType next_type(Cursor& wkb) {
  wkb.set_byte_order(wkb.next<std::uint8_t>() == 1);
  const auto code = wkb.next<std::uint32_t>();
  const std::uint32_t dimension = code / 1000;
  if (code % 1000 < kPoint || code % 1000 > kCollection || dimension > 3) wkb.fail();
  return {code % 1000, dimension == 0 ? 2u : dimension == 3 ? 4u : 3u, dimension == 1 || dimension == 3};
}

/// Calls `visit(x, y, z)` for every vertex, `start_ring` before each ring of a polygon.
void walk(Cursor& wkb, const auto& visit, const auto& start_ring, int depth = 0) {
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
  if (type.kind == kPoint) return vertices(1);
  const auto count = wkb.next<std::uint32_t>();
  if (type.kind < kPolygon) return vertices(count);
  for (std::uint32_t i = 0; i < count && wkb.ok(); ++i) {
    if (type.kind == kPolygon) {
      start_ring(i);
      vertices(wkb.next<std::uint32_t>());
    } else {
      walk(wkb, visit, start_ring, depth + 1);
    }
  }
}

std::optional<std::span<const std::byte>> wkb_of(std::span<const std::byte> blob) {
  const auto header = header_of(blob);
  if (!header) return std::nullopt;
  return blob.subspan(header->size);
}

constexpr auto kNoRings = [](std::uint32_t) {};

}  // namespace

void Envelope::add(double x, double y) {
  min_x = std::min(min_x, x);
  max_x = std::max(max_x, x);
  min_y = std::min(min_y, y);
  max_y = std::max(max_y, y);
}

void Envelope::add(const Envelope& other) {
  if (other.empty()) return;
  add(other.min_x, other.min_y);
  add(other.max_x, other.max_y);
}

PointBlob point_blob(const Eigen::Vector3d& point, std::int32_t srs_id) {
  PointBlob blob;
  std::byte* at = blob.data();
  for (const char c : {'G', 'P', '\0', '\1'}) at = put(at, c);
  at = put(at, srs_id);
  at = put(at, std::uint8_t{1});
  at = put(at, kPoint + kWithZ);
  for (const double value : point) at = put(at, value);
  return blob;
}

std::vector<std::byte> polygons_blob(std::span<const std::vector<Eigen::Vector2d>> rings,
                                     std::int32_t srs_id) {
  std::vector<std::byte> blob;
  append_header(blob, rings.empty() ? 0 : 1, rings.empty(), srs_id);
  Envelope box;
  for (const auto& ring : rings)
    for (const auto& corner : ring) box.add(corner.x(), corner.y());
  if (!rings.empty())
    for (const double side : {box.min_x, box.max_x, box.min_y, box.max_y}) append(blob, side);
  append_wkb_start(blob, kMultiPolygon, rings.size());
  for (const auto& ring : rings) {
    append_wkb_start(blob, kPolygon, 1);
    const bool open = ring.front() != ring.back();
    append(blob, static_cast<std::uint32_t>(ring.size() + open));
    for (std::size_t i = 0; i < ring.size() + open; ++i)
      for (const double value : ring[i % ring.size()]) append(blob, value);
  }
  return blob;
}

std::optional<Envelope> envelope(std::span<const std::byte> blob) {
  const auto wkb = wkb_of(blob);
  if (!wkb) return std::nullopt;
  Cursor cursor(*wkb);
  Envelope box;
  walk(
      cursor, [&](double x, double y, double) { box.add(x, y); }, kNoRings);
  if (!cursor.ok()) return std::nullopt;
  return box;  // an empty point is NaN, NaN in WKB and adds nothing
}

std::optional<std::int32_t> srs_id_of(std::span<const std::byte> blob) {
  const auto header = header_of(blob);
  if (!header) return std::nullopt;
  return header->srs_id;
}

std::optional<Eigen::Vector3d> point_of(std::span<const std::byte> blob) {
  const auto wkb = wkb_of(blob);
  if (!wkb) return std::nullopt;
  Cursor kind(*wkb);
  if (next_type(kind).kind != kPoint) return std::nullopt;
  Cursor cursor(*wkb);
  Eigen::Vector3d point;
  walk(
      cursor,
      [&](double x, double y, double z) {
        point = {x, y, z};
      },
      kNoRings);
  if (!cursor.ok() || !std::isfinite(point.x()) || !std::isfinite(point.y())) return std::nullopt;
  return point;
}

bool has_z(std::span<const std::byte> blob) {
  const auto wkb = wkb_of(blob);
  if (!wkb) return false;
  Cursor cursor(*wkb);
  return next_type(cursor).z && cursor.ok();
}

std::vector<std::vector<Eigen::Vector2d>> polygons_of(std::span<const std::byte> blob) {
  std::vector<std::vector<Eigen::Vector2d>> outer;
  const auto wkb = wkb_of(blob);
  if (!wkb) return outer;
  bool keep = false;
  Cursor cursor(*wkb);
  walk(
      cursor,
      [&](double x, double y, double) {
        if (keep) outer.back().emplace_back(x, y);
      },
      [&](std::uint32_t ring) {
        keep = ring == 0;
        if (keep) outer.emplace_back();
      });
  return outer;
}

}  // namespace waymark

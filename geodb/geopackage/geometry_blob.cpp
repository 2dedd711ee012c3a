// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/geometry_blob.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "geodb/geopackage/wkb_reader.hpp"

namespace waymark::geodb {
namespace {

using namespace wkb;

static_assert(std::endian::native == std::endian::little, "blobs are written as they lie in memory");

constexpr std::uint32_t kWithZ = 1000;

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

constexpr auto kNoRings = [](std::uint32_t, std::uint32_t) {};

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
      [&](std::uint32_t kind, std::uint32_t ring) {
        keep = kind == kPolygon && ring == 0;
        if (keep) outer.emplace_back();
      });
  return outer;
}

}  // namespace waymark::geodb

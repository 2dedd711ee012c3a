// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/shape_blob.hpp"

#include <algorithm>
#include <cstring>

#include "geodb/geopackage/wkb_reader.hpp"

namespace waymark::geodb {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void append_type(std::vector<std::byte>& bytes, std::uint32_t type) {
  append(bytes, std::uint8_t{1});
  append(bytes, type);
}

void append_count(std::vector<std::byte>& bytes, std::size_t count) {
  append(bytes, static_cast<std::uint32_t>(count));
}

void append_corners(std::vector<std::byte>& bytes, std::span<const Eigen::Vector2d> corners) {
  for (const auto& corner : corners)
    for (const double value : corner) append(bytes, value);
}

double doubled_area(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

void append_ring(std::vector<std::byte>& bytes, Ring ring, bool counter_clockwise) {
  if (ring.front() != ring.back()) ring.push_back(ring.front());
  if ((doubled_area(ring) > 0) != counter_clockwise) std::ranges::reverse(ring);
  append_count(bytes, ring.size());
  append_corners(bytes, ring);
}

}  // namespace

Envelope envelope_of(std::span<const ShapePart> parts) {
  Envelope box;
  for (const ShapePart& part : parts)
    for (const auto& corner : part.outer) box.add(corner.x(), corner.y());
  return box;
}

std::vector<std::byte> shape_blob(ShapeKind kind, std::span<const ShapePart> parts, std::int32_t srs_id) {
  std::vector<std::byte> blob;
  const bool point = kind == ShapeKind::point, enveloped = !parts.empty() && !point;
  for (const int byte : {int{'G'}, int{'P'}, 0, 1 | int{enveloped} << 1 | int{parts.empty()} << 4})
    blob.push_back(static_cast<std::byte>(byte));
  append(blob, srs_id);
  const Envelope box = envelope_of(parts);
  if (enveloped)
    for (const double side : {box.min_x, box.max_x, box.min_y, box.max_y}) append(blob, side);
  if (point) {
    append_type(blob, wkb::kPoint);
    const double none = std::numeric_limits<double>::quiet_NaN();
    append_corners(blob, parts.empty() ? Ring{{none, none}} : parts[0].outer);
    return blob;
  }
  append_type(blob, kind == ShapeKind::line ? wkb::kMultiLine : wkb::kMultiPolygon);
  append_count(blob, parts.size());
  for (const ShapePart& part : parts) {
    append_type(blob, kind == ShapeKind::line ? wkb::kLine : wkb::kPolygon);
    if (kind == ShapeKind::line) {
      append_count(blob, part.outer.size());
      append_corners(blob, part.outer);
      continue;
    }
    append_count(blob, 1 + part.holes.size());
    append_ring(blob, part.outer, true);
    for (const auto& hole : part.holes) append_ring(blob, hole, false);
  }
  return blob;
}

std::vector<ShapePart> parts_of(std::span<const std::byte> blob) {
  std::vector<ShapePart> parts;
  const auto bytes = wkb::wkb_of(blob);
  if (!bytes) return parts;
  wkb::Cursor cursor(*bytes);
  Ring* ring = nullptr;
  wkb::walk(
      cursor, [&](double x, double y, double) { ring->emplace_back(x, y); },
      [&](std::uint32_t, std::uint32_t index) {
        if (index == 0 || parts.empty())
          ring = &parts.emplace_back().outer;
        else
          ring = &parts.back().holes.emplace_back();
      });
  if (!cursor.ok()) parts.clear();
  if (parts.size() == 1 && parts[0].outer.size() == 1 && !parts[0].outer[0].allFinite()) parts.clear();
  return parts;
}

}  // namespace waymark::geodb

// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>
namespace waymark::geodb {

/// GeoPackage geometries: "GP", version, flags, srs_id, then WKB (OGC 12-128r18, 2.1.3). Written
/// little-endian, points without an envelope; read in any byte order and of any type.

using PointBlob = std::array<std::byte, 37>;
PointBlob point_blob(const Eigen::Vector3d& point, std::int32_t srs_id);

/// Returns a MULTIPOLYGON of one closed ring per part, with its envelope.
std::vector<std::byte> polygons_blob(std::span<const std::vector<Eigen::Vector2d>> rings,
                                     std::int32_t srs_id);

struct Envelope {
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x;
  double max_x = -std::numeric_limits<double>::infinity(), max_y = max_x;

  bool empty() const { return !(min_x <= max_x); }
  void add(double x, double y);
  void add(const Envelope& other);
  friend bool operator==(const Envelope&, const Envelope&) = default;
};

/// Return `std::nullopt` if the bytes are not a geometry.
std::optional<Envelope> envelope(std::span<const std::byte> blob);
std::optional<std::int32_t> srs_id_of(std::span<const std::byte> blob);

/// Returns the point; `std::nullopt` if the bytes are not a point or the point is empty. A missing z is 0.
std::optional<Eigen::Vector3d> point_of(std::span<const std::byte> blob);
bool has_z(std::span<const std::byte> blob);

/// Returns the closed outer rings of a polygon or multipolygon; empty if the bytes are neither.
std::vector<std::vector<Eigen::Vector2d>> polygons_of(std::span<const std::byte> blob);

}  // namespace waymark::geodb

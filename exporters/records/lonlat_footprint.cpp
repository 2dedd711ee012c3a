// SPDX-License-Identifier: Apache-2.0
#include "exporters/records/lonlat_footprint.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::exporters {
namespace {

constexpr int kPartsOfSide = 16;

/// Returns the corners and divided sides against the clock, not closed; longitudes continue beyond 180.
std::vector<LonLat> continuous_ring(const MapBox& box, const Crs& crs) {
  const CrsTransform to_body(crs, geographic_crs(crs));
  const double xs[] = {box.min_x, box.max_x, box.max_x, box.min_x, box.min_x};
  const double ys[] = {box.min_y, box.min_y, box.max_y, box.max_y, box.min_y};
  std::vector<LonLat> ring;
  for (int side = 0; side < 4; ++side)
    for (int part = 0; part < kPartsOfSide; ++part) {
      const double t = static_cast<double>(part) / kPartsOfSide;
      const auto at = to_body(std::lerp(xs[side], xs[side + 1], t), std::lerp(ys[side], ys[side + 1], t));
      if (!std::isfinite(at.x) || !std::isfinite(at.y))
        throw Error(ErrorCode::input, "the extent leaves the area in which its CRS is defined", crs.id(),
                    "check the CRS and the coordinates");
      LonLat corner{at.x, at.y};
      if (!ring.empty()) corner.lon += 360 * std::round((ring.back().lon - corner.lon) / 360);
      ring.push_back(corner);
    }
  return ring;
}

/// Returns the part of a closed ring on one side of a meridian (Sutherland and Hodgman 1974).
std::vector<LonLat> clipped(const std::vector<LonLat>& ring, double meridian, double sign) {
  std::vector<LonLat> kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const LonLat &from = ring[i], &to = ring[(i + 1) % ring.size()];
    const double a = sign * (from.lon - meridian), b = sign * (to.lon - meridian);
    if (a >= 0) kept.push_back(from);
    if ((a < 0 && b > 0) || (a > 0 && b < 0))
      kept.push_back({meridian, std::lerp(from.lat, to.lat, a / (a - b))});
  }
  return kept;
}

std::vector<LonLat> closed(std::vector<LonLat> ring, double shift) {
  for (LonLat& corner : ring) corner.lon = std::clamp(corner.lon + shift, -180.0, 180.0);
  if (!ring.empty()) ring.push_back(ring.front());
  return ring;
}

LonLatFootprint band(double south, double north) {
  return {.rings = {{{-180, south}, {180, south}, {180, north}, {-180, north}, {-180, south}}},
          .west = -180,
          .south = south,
          .east = 180,
          .north = north};
}

}  // namespace

LonLatFootprint lonlat_footprint(const MapBox& box, const Crs& crs) {
  std::vector<LonLat> ring = continuous_ring(box, crs);
  const auto [south, north] = std::ranges::minmax(ring, {}, &LonLat::lat);
  const auto [first, last] = std::ranges::minmax(ring, {}, &LonLat::lon);
  const double turns = std::round((ring.back().lon - ring.front().lon) / 360);
  if (turns != 0) return south.lat + north.lat > 0 ? band(south.lat, 90) : band(-90, north.lat);
  if (last.lon - first.lon >= 360) return band(south.lat, north.lat);

  const double turn = 360 * std::floor((first.lon + 180) / 360);
  for (LonLat& corner : ring) corner.lon -= turn;
  const double west = first.lon - turn, east = last.lon - turn;
  LonLatFootprint area{.west = west, .south = south.lat, .east = east, .north = north.lat};
  if (east <= 180) {
    area.rings = {closed(ring, 0)};
  } else {
    area.rings = {closed(clipped(ring, 180, -1), 0), closed(clipped(ring, 180, 1), -360)};
    area.east = east - 360;
  }
  return area;
}

}  // namespace waymark::exporters

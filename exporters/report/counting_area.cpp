// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/counting_area.hpp"

#include <fmt/format.h>
#include <ogr_geometry.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/units.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/report/map_drawing.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

constexpr int kSides = 100;             // pieces the longer side of an area is cut into
constexpr std::int64_t kPixels = 1200;  // of a DEM's longer side

/// Returns twice the signed area of a closed ring.
double shoelace(const Corners& ring) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    sum += a.x() * b.y() - b.x() * a.y();
  }
  return sum;
}

OGRLinearRing* ogr_ring(const Corners& corners) {
  auto* ring = new OGRLinearRing;
  for (const Eigen::Vector2d& corner : corners) ring->addPoint(corner.x(), corner.y());
  ring->closeRings();
  return ring;
}

void add_ring(const OGRLinearRing* ring, bool hole, std::vector<CountingArea::Ring>& rings) {
  CountingArea::Ring copy{.corners = {}, .hole = hole};
  for (int i = 0; i < ring->getNumPoints(); ++i) copy.corners.emplace_back(ring->getX(i), ring->getY(i));
  rings.push_back(std::move(copy));
}

void add_polygons(const OGRGeometry& geometry, std::vector<CountingArea::Ring>& rings) {
  if (const auto* polygon = dynamic_cast<const OGRPolygon*>(&geometry)) {
    if (polygon->getExteriorRing() == nullptr) return;
    add_ring(polygon->getExteriorRing(), false, rings);
    for (int i = 0; i < polygon->getNumInteriorRings(); ++i)
      add_ring(polygon->getInteriorRing(i), true, rings);
  }
  if (const auto* parts = dynamic_cast<const OGRGeometryCollection*>(&geometry))
    for (int i = 0; i < parts->getNumGeometries(); ++i) add_polygons(*parts->getGeometryRef(i), rings);
}

std::vector<CountingArea::Ring> union_of(const std::vector<geodb::ImageRecord>& images) {
  const GdalMessages quiet;
  OGRMultiPolygon all;
  for (const geodb::ImageRecord& image : images)
    for (const geodb::ImageRecord::Ring& ring : image.footprint) {
      auto polygon = std::make_unique<OGRPolygon>();
      polygon->addRingDirectly(ogr_ring(ring));
      if (polygon->IsValid()) {
        all.addGeometryDirectly(polygon.release());
        continue;
      }
      const std::unique_ptr<OGRGeometry> mended(polygon->Buffer(0));  // repairs a ring that crosses itself
      if (mended)
        for (auto* part : {mended.get()}) {
          if (const auto* one = dynamic_cast<const OGRPolygon*>(part)) all.addGeometry(one);
          if (const auto* many = dynamic_cast<const OGRMultiPolygon*>(part))
            for (const OGRPolygon* one : *many) all.addGeometry(one);
        }
    }
  std::vector<CountingArea::Ring> rings;
  const std::unique_ptr<OGRGeometry> joined(all.IsEmpty() ? nullptr : all.UnionCascaded());
  if (!joined || joined->IsEmpty()) return rings;
  OGREnvelope box;
  joined->getEnvelope(&box);
  joined->segmentize(std::max(box.MaxX - box.MinX, box.MaxY - box.MinY) / kSides);
  add_polygons(*joined, rings);
  return rings;
}

/// Returns an equal-area projection about the middle of the rings.
Crs equal_area(const std::vector<CountingArea::Ring>& rings, const Crs& crs) {
  Eigen::Vector2d low = rings[0].corners[0], high = low;
  for (const CountingArea::Ring& ring : rings)
    for (const Eigen::Vector2d& corner : ring.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  const Eigen::Vector2d middle = (low + high) / 2;
  const auto there = CrsTransform(crs, geographic_crs(crs))(middle.x(), middle.y());
  const Body& body = crs.body();
  return Crs::from_text(
      fmt::format("+proj=laea +lon_0={:.6f} +lat_0={:.6f} +a={:.3f} +b={:.3f} +units=m "
                  "+no_defs +type=crs",
                  there.x, there.y, body.equatorial_radius, body.polar_radius()));
}

}  // namespace

double polygon_area(const std::vector<CountingArea::Ring>& rings, const Crs& crs) {
  if (rings.empty() || rings[0].corners.empty()) return 0;
  double sum = 0;
  const bool local = crs.kind() == CrsKind::local;
  std::optional<CrsTransform> to_metres;
  if (!local) to_metres.emplace(crs, equal_area(rings, crs));
  for (const CountingArea::Ring& ring : rings) {
    Corners metres = ring.corners;
    for (Eigen::Vector2d& corner : metres)
      if (to_metres) {
        const auto there = (*to_metres)(corner.x(), corner.y());
        corner = {there.x, there.y};
      }
    const double area = std::abs(shoelace(metres)) / 2;
    sum += ring.hole ? -area : area;
  }
  return std::isfinite(sum) ? std::max(0.0, sum) : 0;
}

double area_of(const Relief& relief, const Crs& crs) {
  const auto rows = relief.heights.rows();
  const double radius = crs.kind() == CrsKind::geographic ? crs.body().mean_radius() : 0;
  double sum = 0;
  for (std::int64_t r = 0; r < rows; ++r) {
    std::int64_t known = 0;
    for (const float height : relief.heights.row(r)) known += !std::isnan(height);
    double cell = relief.cell_x * relief.cell_y;
    if (radius > 0) {
      const double step = relief.extent.height() / static_cast<double>(rows);
      const double north = relief.extent.north - step * static_cast<double>(r);
      const double width = relief.extent.width() / static_cast<double>(relief.heights.columns());
      cell = radius * radius * width * kRadiansPerDegree *
             (std::sin(north * kRadiansPerDegree) - std::sin((north - step) * kRadiansPerDegree));
    }
    sum += cell * static_cast<double>(known);
  }
  return sum;
}

std::optional<CountingArea> counting_area(const geodb::MapStore& map) {
  CountingArea area;
  const auto images = map.images();
  area.rings = union_of(images);
  area.square_metres = polygon_area(area.rings, map.crs());
  if (area.square_metres > 0) {
    area.source = images.size() == 1 ? "the footprint of one image"
                                     : fmt::format("the footprints of {} images together", images.size());
    return area;
  }
  area.rings.clear();
  if (!images.empty()) return {};
  const auto relief = read_relief(relief_names(map), map.crs(), 0, kPixels);
  if (relief) area.square_metres = area_of(*relief, map.crs());
  area.source = "the DEM";
  return area.square_metres > 0 ? std::optional(area) : std::nullopt;
}

}  // namespace waymark::exporters

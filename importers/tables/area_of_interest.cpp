// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/area_of_interest.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "importers/tables/vector_layer.hpp"

namespace waymark::importers {
namespace {

// Counts crossings of the ray towards +x.
bool is_inside(const std::vector<Area::Ring>& rings, double x, double y) {
  bool inside = false;
  for (const Area::Ring& ring : rings)
    for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) {
      const Eigen::Vector2d &a = ring[last], &b = ring[i];
      if ((a.y() > y) == (b.y() > y)) continue;
      if (x < a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y())) inside = !inside;
    }
  return inside;
}

constexpr double kEdgesPerSide = 100;  // of a polygon's bounding box, where it is transformed

using Polygons = std::vector<std::vector<Area::Ring>>;

void collect_area(const OGRGeometry& geometry, const CrsTransform* transform, const std::string& path,
                  Polygons& polygons) {
  if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection)) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection())
      collect_area(*part, transform, path, polygons);
    return;
  }
  if (wkbFlatten(geometry.getGeometryType()) != wkbPolygon || geometry.IsEmpty()) return;
  auto& rings = polygons.emplace_back();
  for (const OGRLinearRing* ring : *geometry.toPolygon()) {
    auto& corners = rings.emplace_back();
    for (const OGRPoint& corner : *ring) {
      Eigen::Vector2d at(corner.getX(), corner.getY());
      if (transform) {
        const auto moved = (*transform)(at.x(), at.y());
        at = {moved.x, moved.y};
      }
      if (!at.allFinite())
        throw Error(ErrorCode::input, "a corner of the area lies outside the domain of the map's CRS", path,
                    "cut the polygons to the map: ogr2ogr -clipsrc");
      corners.push_back(at);
    }
  }
}

}  // namespace

Area::Area(std::vector<std::vector<Ring>> polygons, bool degrees) : degrees_(degrees) {
  for (auto& rings : polygons) {
    Part part{.rings = std::move(rings),
              .low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()),
              .high = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity())};
    for (const Ring& ring : part.rings)
      for (const Eigen::Vector2d& corner : ring) {
        part.low = part.low.cwiseMin(corner);
        part.high = part.high.cwiseMax(corner);
      }
    parts_.push_back(std::move(part));
  }
}

bool Area::contains(double x, double y) const {
  for (const double turn : {0.0, -360.0, 360.0}) {
    if (turn != 0 && !degrees_) break;
    const double at = x + turn;
    for (const Part& part : parts_)
      if (at >= part.low.x() && at <= part.high.x() && y >= part.low.y() && y <= part.high.y() &&
          is_inside(part.rings, at, y))
        return true;
  }
  return false;
}

Eigen::AlignedBox2d Area::box() const {
  Eigen::AlignedBox2d box;
  for (const Part& part : parts_) box.extend(Eigen::AlignedBox2d(part.low, part.high));
  return box;
}

Area read_area_of_interest(const std::string& path, const Crs& into) {
  const GdalDataset dataset =
      open_vector(path, "file of areas", "areas are polygons: GeoPackage, GeoJSON, ...");
  Polygons polygons;
  for (OGRLayer* layer : dataset->GetLayers()) {
    const std::optional<Crs> own = crs_of(*layer);
    std::optional<CrsTransform> transform;
    if (own && into.kind() != CrsKind::local && !own->same_as(into)) transform.emplace(*own, into);
    const GdalListener quiet;
    for (const auto& feature : *layer) {
      const OGRGeometry* given = feature->GetGeometryRef();
      if (given == nullptr || given->IsEmpty()) continue;
      const std::unique_ptr<OGRGeometry> geometry(given->getLinearGeometry());
      OGREnvelope box;
      geometry->getEnvelope(&box);
      const double side = std::max(box.MaxX - box.MinX, box.MaxY - box.MinY);
      if (transform && side > 0) geometry->segmentize(side / kEdgesPerSide);
      collect_area(*geometry, transform ? &*transform : nullptr, path, polygons);
    }
  }
  if (polygons.empty())
    throw Error(ErrorCode::input, "the file of areas holds no polygon", path, "draw at least one polygon");
  return {std::move(polygons), into.kind() == CrsKind::geographic};
}

void check_area_meets(const Area& area, const GridGeometry& grid, const std::string& data,
                      const std::string& path) {
  const Georeference& at = grid.where;
  const double right = static_cast<double>(grid.columns) - 0.5, bottom = static_cast<double>(grid.rows) - 0.5;
  Eigen::AlignedBox2d box(Eigen::Vector2d(at.x(-0.5), at.y(bottom)));
  box.extend(Eigen::Vector2d(at.x(right), at.y(-0.5)));
  const Eigen::AlignedBox2d asked = area.box();
  const double turns = at.crs.kind() == CrsKind::geographic ? 1 : 0;
  for (double turn = -360 * turns; turn <= 360 * turns; turn += 360)
    if (box.translated(Eigen::Vector2d(turn, 0)).intersects(asked)) return;
  const auto extent = [](const Eigen::AlignedBox2d& of) {
    return fmt::format("x {:.10g} to {:.10g}, y {:.10g} to {:.10g}", of.min().x(), of.max().x(), of.min().y(),
                       of.max().y());
  };
  throw Error(ErrorCode::input, "the area of interest lies off " + data, path,
              fmt::format("{} covers {} in {}, the area {}", data, extent(box), at.crs.id(), extent(asked)));
}

}  // namespace waymark::importers

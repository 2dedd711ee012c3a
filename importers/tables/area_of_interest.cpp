// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/area_of_interest.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "importers/tables/vector_layer.hpp"

namespace waymark::importers {
namespace {

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

}  // namespace waymark::importers

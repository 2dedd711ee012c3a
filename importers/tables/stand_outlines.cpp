// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/stand_outlines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "core/error.hpp"
#include "importers/tables/vector_layer.hpp"

namespace waymark::importers {
namespace {

constexpr double kMaxCoordinate = 1e9;  // CRS units; the largest body that is mapped has 7e7 m around it
constexpr double kMaxSharedArea = 1;    // m2; neighbours may overlap this much by rounding

using Geometry = std::unique_ptr<OGRGeometry>;

bool may_hold_polygons(OGRLayer& layer) {
  const OGRwkbGeometryType type = wkbFlatten(layer.GetGeomType());
  return type == wkbPolygon || type == wkbMultiPolygon || type == wkbUnknown ||
         type == wkbGeometryCollection || type == wkbCurvePolygon || type == wkbMultiSurface;
}

OGRLayer& choose_layer(GDALDataset& dataset, const std::string& path, const std::string& name) {
  std::vector<std::string> all, areas;
  for (OGRLayer* layer : dataset.GetLayers()) {
    all.emplace_back(layer->GetName());
    if (may_hold_polygons(*layer)) areas.emplace_back(layer->GetName());
  }
  if (!name.empty()) return layer_named(dataset, path, name, all);
  if (areas.empty())
    throw Error(ErrorCode::input, "the file has no layer of polygons", path,
                all.empty() ? "it is empty" : fmt::format("it has: {}", fmt::join(all, ", ")));
  for (const char* usual : {"stand", "stands"})
    if (std::ranges::count(areas, usual) > 0) return *dataset.GetLayerByName(usual);
  if (areas.size() == 1) return *dataset.GetLayerByName(areas[0].c_str());
  throw Error(ErrorCode::usage, "the file holds several layers of polygons", path,
              fmt::format("choose one with --stands-layer: {}", fmt::join(areas, ", ")));
}

int column_of(OGRLayer& layer, std::initializer_list<const char*> names) {
  for (const char* name : names)  // without regard to case
    if (const int index = layer.GetLayerDefn()->GetFieldIndex(name); index >= 0) return index;
  return -1;
}

/// Collects the polygons of a geometry; skips other parts of a collection.
void collect_polygons(const OGRGeometry& geometry, std::vector<const OGRPolygon*>& polygons) {
  if (wkbFlatten(geometry.getGeometryType()) == wkbPolygon) {
    polygons.push_back(geometry.toPolygon());
  } else if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection)) {
    for (const OGRGeometry* part : *geometry.toGeometryCollection()) collect_polygons(*part, polygons);
  }
}

/// Reads stands with their geometries in the requested CRS.
class Reader {
 public:
  Reader(const std::string& path, const std::string& name, const Crs& into)
      : path_(path),
        dataset_(open_vector(path, "file of stands",
                             "stands are polygons: a GeoPackage, Shapefile, GeoJSON, ...")),
        layer_(&choose_layer(*dataset_, path, name)) {
    const std::optional<Crs> own = crs_of(*layer_);
    if (into.kind() == CrsKind::local) {
      if (own && own->kind() != CrsKind::local && own->id() != "EPSG:4326")
        warn(fmt::format("{}: its CRS {} is ignored, since that of the map is local", path, own->id()));
    } else if (!own) {
      warn(fmt::format("{} has no CRS: the map's is assumed, {}", path, into.id()));
    } else if (!own->same_as(into)) {
      transform_.emplace(*own, into);
    }
    name_column_ = column_of(*layer_, {"stand", "stand_id", "name", "plot", "plot_id", "id", "fid"});
    species_column_ = column_of(*layer_, {"species", "type", "forest_type"});
  }

  StandOutlines read() {
    layer_->ResetReading();
    for (const auto& feature : *layer_) add(*feature);
    if (out_.stands.empty() && out_.failed.empty())
      throw Error(ErrorCode::input, "the layer of stands has no rows", path_, "draw at least one polygon");
    warn_of_overlaps();
    return std::move(out_);
  }

 private:
  void warn(std::string text) { out_.warnings.push_back(std::move(text)); }

  std::string name_of(const OGRFeature& feature) {
    std::string name = name_column_ >= 0 ? feature.GetFieldAsString(name_column_) : "";
    if (name.empty()) name = fmt::format("{}", feature.GetFID());
    const int times = ++used_[name];
    if (times > 1) {
      warn(fmt::format("stand {} occurs {} times: this one is named {} ({})", name, times, name, times));
      name = fmt::format("{} ({})", name, times);
    }
    return name;
  }

  void add(const OGRFeature& feature) {
    StandOutline stand{.name = name_of(feature), .species = {}, .polygons = {}};
    if (species_column_ >= 0) stand.species = feature.GetFieldAsString(species_column_);
    const auto fail = [&](const std::string& why) {
      out_.failed.push_back(fmt::format("stand {} {}", stand.name, why));
    };
    const OGRGeometry* given = feature.GetGeometryRef();
    if (given == nullptr || given->IsEmpty()) return fail("has no geometry");
    Geometry geometry(given->getLinearGeometry());
    geometry->flattenTo2D();
    if (!move(*geometry)) return fail("has corners outside the domain of the map's CRS");
    OGREnvelope box;
    geometry->getEnvelope(&box);
    for (const double corner : {box.MinX, box.MinY, box.MaxX, box.MaxY})
      if (!(std::abs(corner) <= kMaxCoordinate))
        return fail(fmt::format("has a corner at {:.6g}, farther out than any map reaches", corner));
    {
      const GdalListener quiet;
      if (!geometry->IsValid()) {
        const double before = area_of(*geometry);
        geometry.reset(geometry->MakeValid());
        if (!geometry) return fail("crosses itself and cannot be repaired");
        warn(fmt::format("stand {} crosses itself: repaired, {:.1f} of {:.1f} square units are left",
                         stand.name, area_of(*geometry), before));
      }
    }
    std::vector<const OGRPolygon*> polygons;
    collect_polygons(*geometry, polygons);
    for (const OGRPolygon* polygon : polygons) {
      auto& rings = stand.polygons.emplace_back();
      for (const OGRLinearRing* ring : *polygon) {
        auto& corners = rings.emplace_back();
        for (const OGRPoint& corner : *ring) corners.emplace_back(corner.getX(), corner.getY());
      }
    }
    if (polygons.empty())
      return fail(fmt::format("is a {}, not a polygon", OGRGeometryTypeToName(given->getGeometryType())));
    if (!(area_of(*geometry) > 0)) return fail("has no area");
    out_.stands.push_back(std::move(stand));
    geometries_.push_back(std::move(geometry));
  }

  static double area_of(const OGRGeometry& geometry) {
    std::vector<const OGRPolygon*> polygons;
    collect_polygons(geometry, polygons);
    double sum = 0;
    for (const OGRPolygon* polygon : polygons) sum += polygon->get_Area();
    return sum;
  }

  /// Transforms corners only: edges of stands are short.
  bool move(OGRGeometry& geometry) {
    if (!transform_) return true;
    std::vector<const OGRPolygon*> polygons;
    collect_polygons(geometry, polygons);
    for (const OGRPolygon* polygon : polygons)
      for (const OGRLinearRing* ring : *polygon) {
        auto* corners = const_cast<OGRLinearRing*>(ring);  // of a geometry of our own
        for (int i = 0; i < corners->getNumPoints(); ++i) {
          const auto at = (*transform_)(corners->getX(i), corners->getY(i));
          if (!std::isfinite(at.x) || !std::isfinite(at.y)) return false;
          corners->setPoint(i, at.x, at.y);
        }
      }
    return true;
  }

  void warn_of_overlaps() {
    std::vector<OGREnvelope> boxes(geometries_.size());
    for (std::size_t i = 0; i < geometries_.size(); ++i) geometries_[i]->getEnvelope(&boxes[i]);
    constexpr int kMaxReported = 20;
    int overlaps = 0;
    const GdalListener quiet;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        if (!boxes[i].Intersects(boxes[j])) continue;
        const Geometry both(geometries_[i]->Intersection(geometries_[j].get()));
        const double shared = both ? area_of(*both) : 0;
        if (shared > kMaxSharedArea && ++overlaps <= kMaxReported)
          warn(fmt::format("stands {} and {} overlap by {:.1f} square units: trees there are counted in both",
                           out_.stands[i].name, out_.stands[j].name, shared));
      }
    if (overlaps > kMaxReported)
      warn(fmt::format("{} more pairs of stands overlap", overlaps - kMaxReported));
  }

  std::string path_;
  GdalDataset dataset_;
  OGRLayer* layer_;
  std::optional<CrsTransform> transform_;
  int name_column_ = -1, species_column_ = -1;
  std::map<std::string, int> used_;
  std::vector<Geometry> geometries_;
  StandOutlines out_;
};

}  // namespace

StandOutlines read_stand_outlines(const std::string& path, const std::string& layer, const Crs& into) {
  return Reader(path, layer, into).read();
}

}  // namespace waymark::importers

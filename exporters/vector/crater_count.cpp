// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/crater_count.hpp"

#include <fmt/format.h>
#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "exporters/report/counting_area.hpp"
#include "exporters/report/landmark_section.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

struct Crater {
  double kilometres = 0;  ///< diameter
  Eigen::Vector2d at;     ///< map
};

const LandmarkType& type_of(const geodb::MapStore& map, const ExportOptions& options,
                            const std::string& shown) {
  if (options.types.size() > 1)
    throw Error(ErrorCode::usage, "a crater count holds one type", "--type", "name one, or none for craters");
  const auto bowl = find_type(map.types(), EvidenceModel::bowl);
  const LandmarkType* type = !options.types.empty() ? map.types().find(options.types.front())
                             : bowl                 ? &map.types()[*bowl]
                                                    : nullptr;
  if (type == nullptr || type->body.feature.empty())
    throw Error(ErrorCode::usage,
                options.types.empty()
                    ? "the map has no craters to count"
                    : fmt::format("the map has no type '{}' with a size to count", options.types.front()),
                shown, "crater counts need a map with craters; other formats hold any type");
  return *type;
}

CountingArea area_of(const geodb::MapStore& map, const ExportOptions& options) {
  auto area = counting_area(map);
  if (!(options.area_km2 >= 0))
    throw Error(ErrorCode::usage, fmt::format("--area is {:g} km2", options.area_km2), "",
                "it must be larger than 0");
  if (options.area_km2 > 0) {
    if (!area || std::abs(area->square_metres / 1e6 / options.area_km2 - 1) > 0.01) area = CountingArea{};
    area->square_metres = options.area_km2 * 1e6;
  }
  if (area) return *area;
  throw Error(ErrorCode::usage, "the area on which the craters were counted is not known",
              map.path().string(), "the map has no image footprints and its DEM is missing: pass --area KM2");
}

/// Tests a point by the even-odd rule over all rings.
bool inside(const std::vector<CountingArea::Ring>& rings, const Eigen::Vector2d& at) {
  bool in = rings.empty();
  for (const CountingArea::Ring& ring : rings)
    for (std::size_t i = 0; i + 1 < ring.corners.size(); ++i) {
      const Eigen::Vector2d &a = ring.corners[i], &b = ring.corners[i + 1];
      if ((a.y() > at.y()) != (b.y() > at.y()) &&
          at.x() < (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y()) + a.x())
        in = !in;
    }
  return in;
}

std::vector<Crater> craters_of(const geodb::MapStore& map, const LandmarkType& type, const CountingArea& area,
                               ExportSummary& summary) {
  const auto size = find_feature(type, type.body.feature);
  std::vector<Crater> craters;
  std::int64_t unsized = 0, outside = 0;
  for (const Landmark& landmark : map.query({.types = {type.name}})) {
    const Crater crater{2 * type.body.radius_per_value * value_of(landmark, size) / 1000,
                        landmark.position.xyz.head<2>()};
    if (!(crater.kilometres > 0))
      ++unsized;
    else if (!inside(area.rings, crater.at))
      ++outside;
    else
      craters.push_back(crater);
  }
  if (unsized > 0) summary.warnings.push_back(fmt::format("{} without a size are left out", unsized));
  if (outside > 0)
    summary.warnings.push_back(
        fmt::format("{} whose centre lies outside the counting area are left out", outside));
  summary.layers = {{type.name, static_cast<std::int64_t>(craters.size())}};
  return craters;
}

double half_turns(double longitude) {
  return std::remainder(longitude, 360);
}

std::string boundary_text(const std::vector<CountingArea::Ring>& rings, const CrsTransform& to_degrees) {
  if (rings.empty()) return {};
  std::string text = "unit_boundary = {vertex,sub_area,tag,lon,lat\n#\n";
  for (std::size_t i = 0; i < rings.size(); ++i)
    text += fmt::format("# Area_name{} = {}\n", i + 1, rings[i].hole ? "hole" : "images");
  text += "#\n";
  int vertex = 0;
  for (std::size_t i = 0; i < rings.size(); ++i)
    for (const Eigen::Vector2d& corner : rings[i].corners) {
      const auto there = to_degrees(corner.x(), corner.y());
      text += fmt::format("{}\t{}\t{}\t{:.12g}\t{:.12g}\n", ++vertex, i + 1, rings[i].hole ? "int" : "ext",
                          half_turns(there.x), there.y);
    }
  return text + "}\n#\n";
}

std::string scc_text(const geodb::MapStore& map, const CountingArea& area,
                     const std::vector<Crater>& craters) {
  const Body& body = map.crs().body();
  const Crs degrees = geographic_crs(map.crs());
  const CrsTransform to_degrees(map.crs(), degrees);
  std::string text = "# Spatial crater count\n#\n# Ellipsoid axes:\n";
  text += fmt::format(
      "a_axis_radius = {:.10g} <km>\nb_axis_radius = {:.10g} <km>\nc_axis_radius = {:.10g} <km>\n",
      body.equatorial_radius / 1000, body.equatorial_radius / 1000, body.polar_radius() / 1000);
  text += fmt::format("coordinate_system_name = {}\n#\n", degrees.id());
  text += boundary_text(area.rings, to_degrees);
  // craterstats reads no exponents
  text += fmt::format("Total_area = {:.9f} <km^2>\n#\n# crater_diameters:\ncrater = {{diam,lon,lat\n",
                      area.square_metres / 1e6);
  for (const Crater& crater : craters) {
    const auto there = to_degrees(crater.at.x(), crater.at.y());
    text += fmt::format("{:.12g}\t{:.12g}\t{:.12g}\n", crater.kilometres, half_turns(there.x), there.y);
  }
  return text + "}\n";
}

std::string diam_text(const CountingArea& area, const std::vector<Crater>& craters) {
  std::string text = fmt::format("area={:.9f}\ncrater={{diameter,fraction\n", area.square_metres / 1e6);
  for (const Crater& crater : craters) text += fmt::format("{:.12g} 1\n", crater.kilometres);
  return text + "}\n";
}

}  // namespace

bool is_crater_count(const std::string& out) {
  return out.ends_with(".scc") || out.ends_with(".diam");
}

ExportSummary export_crater_count(const fs::path& map_path, const std::string& out,
                                  const ExportOptions& options) {
  const bool with_places = out.ends_with(".scc");
  const geodb::MapStore map = geodb::MapStore::open(map_path);
  if (with_places && map.crs().kind() == CrsKind::local)
    throw Error(ErrorCode::usage, "a .scc has longitudes and latitudes, but the map is on no body", out,
                "write .diam, which holds diameters and an area");
  if (!options.crs.empty())
    throw Error(ErrorCode::usage, "a crater count has no CRS of its own", "--crs " + options.crs,
                "leave --crs out: .scc holds longitude and latitude on the map's body");
  if (options.inside)
    throw Error(ErrorCode::usage, "a crater count needs all craters of its counting area", "--aoi",
                "leave --aoi out");
  if (options.min_confidence > 0)
    throw Error(ErrorCode::usage, "a crater count needs all craters of its counting area", "--min-confidence",
                "leave --min-confidence out, or export a map of likely craters first, and that map then");
  if (!options.overwrite && fs::exists(out))
    throw Error(ErrorCode::output, fmt::format("{} exists already", fs::path(out).filename().string()), out,
                "remove it, choose another name, or allow it to be replaced with --overwrite");
  ExportSummary summary;
  const LandmarkType& type = type_of(map, options, map_path.string());
  const CountingArea area = area_of(map, options);
  const auto craters = craters_of(map, type, area, summary);
  summary.driver = with_places ? "craterstats SCC" : "craterstats DIAM";
  summary.crs = with_places ? geographic_crs(map.crs()).id() : "no positions";
  summary.files = {out};
  write_file(out, with_places ? scc_text(map, area, craters) : diam_text(area, craters));
  return summary;
}

}  // namespace waymark::exporters

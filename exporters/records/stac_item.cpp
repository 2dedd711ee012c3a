// SPDX-License-Identifier: Apache-2.0
#include "exporters/records/stac_item.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace waymark::exporters {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStacVersion = "1.1.0";

std::string extension(const char* name_and_version) {
  return std::string("https://stac-extensions.github.io/") + name_and_version + "/schema.json";
}

bool has_place(const RecordFacts& facts) {
  return facts.box && facts.crs.kind() != CrsKind::local;
}

Json bbox_of(const LonLatFootprint& area) {
  return {area.west, area.south, area.east, area.north};
}

Json geometry_of(const LonLatFootprint& area) {
  Json polygons = Json::array();
  for (const auto& ring : area.rings) {
    Json corners = Json::array();
    for (const LonLat& corner : ring) corners.push_back({corner.lon, corner.lat});
    polygons.push_back(Json::array({std::move(corners)}));
  }
  if (polygons.size() == 1) return {{"type", "Polygon"}, {"coordinates", polygons[0]}};
  return {{"type", "MultiPolygon"}, {"coordinates", polygons}};
}

// Names and classes of the IVOA, as the extension wants them; other bodies are left out.
const char* target_class(const Body& body) {
  for (const char* planet : {"Mercury", "Venus", "Earth", "Mars", "Jupiter", "Saturn", "Uranus", "Neptune"})
    if (body.name == planet) return "planet";
  for (const char* satellite : {"Moon", "Phobos", "Deimos", "Io", "Europa", "Ganymede", "Callisto", "Titan",
                                "Enceladus", "Mimas", "Tethys", "Dione", "Rhea", "Iapetus"})
    if (body.name == satellite) return "satellite";
  return nullptr;
}

void add_times(Json& properties, const RecordFacts& facts) {
  const bool spans = !facts.first_image.empty() && facts.first_image != facts.last_image;
  properties["datetime"] = spans                       ? Json(nullptr)
                           : facts.first_image.empty() ? Json(facts.created)
                                                       : Json(facts.first_image);
  if (spans) {
    properties["start_datetime"] = facts.first_image;
    properties["end_datetime"] = facts.last_image;
  }
  properties["created"] = facts.created;
}

void add_projection(Json& properties, const RecordFacts& facts) {
  const bool coded = !facts.crs.authority().empty() && !facts.crs.code().empty();
  properties["proj:code"] = coded ? Json(facts.crs.id()) : Json(nullptr);
  properties["proj:wkt2"] = facts.crs.wkt2().empty() ? Json(nullptr) : Json(facts.crs.wkt2());
  if (facts.box)
    properties["proj:bbox"] = {facts.box->min_x, facts.box->min_y, facts.box->max_x, facts.box->max_y};
  if (!facts.transform) return;
  const auto& t = *facts.transform;  // GDAL begins with the corner, the extension with the step
  properties["proj:transform"] = {t[1], t[2], t[0], t[4], t[5], t[3]};
  properties["proj:shape"] = facts.shape;
}

Json assets_of(const RecordFacts& facts) {
  Json assets = Json::object();
  for (const RecordAsset& asset : facts.assets)
    // Multihash: 12 is SHA-256, 20 its length in bytes, both hexadecimal.
    assets[asset.key] = {{"href", asset.href},       {"type", asset.type},
                         {"title", asset.title},     {"roles", asset.roles},
                         {"file:size", asset.bytes}, {"file:checksum", "1220" + asset.sha256}};
  return assets;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string stac_item(const RecordFacts& facts, const std::string& collection) {
  Json extensions = {extension("projection/v2.0.0"), extension("file/v2.1.0")};
  Json properties;
  if (!facts.title.empty()) properties["title"] = facts.title;
  if (!facts.description.empty()) properties["description"] = facts.description;
  add_times(properties, facts);
  add_projection(properties, facts);
  if (const char* kind = facts.crs.kind() == CrsKind::local ? nullptr : target_class(facts.crs.body())) {
    extensions.push_back(extension("ssys/v1.1.0"));
    properties["ssys:targets"] = {facts.crs.body().name};
    properties["ssys:target_class"] = kind;
  }
  if (facts.gsd) properties["gsd"] = *facts.gsd;
  if (facts.sun_azimuth && facts.sun_elevation) {
    extensions.push_back(extension("view/v1.1.0"));
    properties["view:sun_azimuth"] = *facts.sun_azimuth;
    properties["view:sun_elevation"] = *facts.sun_elevation;
  }
  if (!facts.software_version.empty()) {
    extensions.push_back(extension("processing/v1.2.0"));
    properties["processing:software"] = {{"Waymark", facts.software_version}};
    if (!facts.lineage.empty()) properties["processing:lineage"] = facts.lineage;
  }
  if (!facts.landmarks.empty()) {
    Json numbers = Json::object();
    for (const auto& [type, count] : facts.landmarks) numbers[type] = count;
    properties["waymark:landmarks"] = numbers;
  }
  Json item{{"type", "Feature"},
            {"stac_version", kStacVersion},
            {"stac_extensions", extensions},
            {"id", facts.id},
            {"geometry", nullptr}};
  if (has_place(facts)) {
    const LonLatFootprint area = lonlat_footprint(*facts.box, facts.crs);
    item["geometry"] = geometry_of(area);
    item["bbox"] = bbox_of(area);
  }
  item["properties"] = properties;
  item["links"] = Json::array();
  if (!collection.empty()) {
    for (const char* relation : {"root", "parent", "collection"})
      item["links"].push_back(
          {{"rel", relation}, {"href", "./collection.json"}, {"type", "application/json"}});
    item["collection"] = collection;
  }
  item["assets"] = assets_of(facts);
  return text_of(item);
}

std::string stac_collection(const std::string& id, const std::string& description,
                            std::span<const RecordFacts> items) {
  std::vector<LonLatFootprint> areas;
  std::string first, last;
  Json links = Json::array({{{"rel", "root"}, {"href", "./collection.json"}, {"type", "application/json"}}});
  for (const RecordFacts& facts : items) {
    if (has_place(facts)) areas.push_back(lonlat_footprint(*facts.box, facts.crs));
    const std::string& from = facts.first_image.empty() ? facts.created : facts.first_image;
    const std::string& to = facts.first_image.empty() ? facts.created : facts.last_image;
    first = first.empty() ? from : std::min(first, from);
    last = std::max(last, to);
    links.push_back({{"rel", "item"}, {"href", "./" + facts.id + ".json"}, {"type", "application/geo+json"}});
  }
  Json boxes = Json::array();
  if (areas.empty()) {
    boxes.push_back({-180, -90, 180, 90});
  } else {
    // Two boxes across the antimeridian have no smaller common one without a search: all longitudes then.
    const bool crosses = std::ranges::any_of(areas, [](const auto& area) { return area.west > area.east; });
    const auto low = [&](auto member) { return std::ranges::min(areas, {}, member).*member; };
    const auto high = [&](auto member) { return std::ranges::max(areas, {}, member).*member; };
    boxes.push_back({crosses ? -180 : low(&LonLatFootprint::west), low(&LonLatFootprint::south),
                     crosses ? 180 : high(&LonLatFootprint::east), high(&LonLatFootprint::north)});
    if (areas.size() > 1)
      for (const LonLatFootprint& area : areas) boxes.push_back(bbox_of(area));
  }
  return text_of({{"type", "Collection"},
                  {"stac_version", kStacVersion},
                  {"id", id},
                  {"description", description},
                  {"license", "other"},
                  {"extent",
                   {{"spatial", {{"bbox", boxes}}},
                    {"temporal", {{"interval", Json::array({Json::array({first, last})})}}}}},
                  {"links", links}});
}

}  // namespace waymark::exporters

// SPDX-License-Identifier: Apache-2.0
#include "apps/query_request.hpp"

#include <algorithm>

#include "apps/parse.hpp"
#include "apps/query_area.hpp"
#include "apps/registries.hpp"
#include "core/error.hpp"

namespace waymark {
namespace {

double at_least_zero(const std::string& what, double value) {
  if (!(value >= 0)) throw Error(ErrorCode::usage, what + " must be 0 or more, is " + std::to_string(value));
  return value;
}

/// "prominence=300" of --min or --max.
std::pair<std::string, double> bound(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw Error(ErrorCode::usage, option + " takes FEATURE=VALUE, is '" + text + "'", "",
                "e.g. " + option + " prominence=300");
  const std::string feature = text.substr(0, equals);
  return {feature, to_number(option + " " + feature, text.substr(equals + 1))};
}

CrsTransform::XY in_map(const std::vector<double>& point, const Crs& from, const MapStore& map) {
  if (from.same_as(map.crs())) return {point[0], point[1]};
  return CrsTransform(from, map.crs())(point[0], point[1]);
}

}  // namespace

std::vector<Argument> query_arguments(QueryRequest& request) {
  return {
      Argument{"--type", "T", &request.types, "Landmarks of this type; may be repeated"}
          .offering(all_types().names())
          .or_else("all"),
      {"--bbox", "X0 Y0 X1 Y1", &request.bbox, "Landmarks in this box; X0 > X1 crosses the antimeridian"},
      {"--near", "X Y RADIUS", &request.near, "Landmarks within RADIUS metres of X Y, nearest first"},
      {"--nearest", "X Y COUNT", &request.nearest, "The COUNT landmarks nearest to X Y"},
      {"--min", "FEATURE=VALUE", &request.lowest,
       "Landmarks whose feature is at least this; may be repeated"},
      {"--max", "FEATURE=VALUE", &request.highest,
       "Landmarks whose feature is at most this; may be repeated"},
      Argument{"--crs", "CRS", &request.crs, "CRS of the coordinates given and printed"}.or_else("the map's"),
      Argument{"--sensor", "NAME", &request.sensor,
               "Quality as this sensor sees it; `waymark sensors` lists them"}
          .offering(all_sensors().names()),
      {"--min-quality", "Q", &request.min_quality, "Landmarks of at least this quality, 0 to 1"},
      {"--largest", "FEATURE", &request.largest, "Largest values of this feature, or of quality, first"},
      {"--limit", "N", &request.limit, "At most this many"},
  };
}

MapQuestion::MapQuestion(const QueryRequest& request, const MapStore& map)
    : crs_(request.crs.empty() ? map.crs() : Crs::from_text(request.crs)),
      limit_(static_cast<std::size_t>(at_least_zero("--limit", static_cast<double>(request.limit)))) {
  for (const std::string& type : request.types)
    static_cast<void>(map.types().id(type));  // throws the nearest name
  query_.types = request.types;
  query_.min_quality = request.min_quality;
  query_.largest_first = request.largest;
  if (!request.sensor.empty()) query_.sensor = &all_sensors().at(request.sensor);
  for (const std::string& text : request.lowest) {
    const auto [feature, value] = bound("--min", text);
    query_.features.push_back({.feature = feature, .lowest = value});
  }
  for (const std::string& text : request.highest) {
    const auto [feature, value] = bound("--max", text);
    query_.features.push_back({.feature = feature, .highest = value});
  }
  ask_near(request, map);
  ask_box(request, map);
  if (!outline_) {
    query_.limit = request.limit;
  } else if (query_.nearest) {  // which of the nearest are inside is known only afterwards
    limit_ = std::min(limit_, static_cast<std::size_t>(query_.nearest->k));
    query_.nearest->k = map.count();
  }
}

void MapQuestion::ask_near(const QueryRequest& request, const MapStore& map) {
  if (!request.near.empty()) {
    const auto centre = in_map(request.near, crs_, map);
    query_.near =
        MapQuery::Near{centre.x, centre.y, Meters{at_least_zero("RADIUS of --near", request.near[2])}};
  }
  if (!request.nearest.empty()) {
    const auto centre = in_map(request.nearest, crs_, map);
    const double count = at_least_zero("COUNT of --nearest", request.nearest[2]);
    query_.nearest = MapQuery::NearestK{centre.x, centre.y, static_cast<std::int64_t>(count)};
  }
}

void MapQuestion::ask_box(const QueryRequest& request, const MapStore& map) {
  if (request.bbox.empty()) return;
  const MapQuery::Box box{request.bbox[0], request.bbox[1], request.bbox[2], request.bbox[3]};
  if (box.min_y > box.max_y || (box.min_x > box.max_x && crs_.kind() != CrsKind::geographic))
    throw Error(ErrorCode::usage,
                "--bbox takes the lower left and the upper right corner: X0 <= X1, Y0 <= Y1");
  query_.box = box;
  if (crs_.same_as(map.crs())) return;
  outline_ = box;
  query_.box = covering_box(box, crs_, map.crs());
}

std::vector<Landmark> MapQuestion::answer(const MapStore& map) const {
  std::vector<Landmark> found = map.query(query_);
  if (!outline_) return found;
  const CrsTransform transform(map.crs(), crs_);
  std::erase_if(found, [&](const Landmark& landmark) {
    const auto at = transform(landmark.position.xyz.x(), landmark.position.xyz.y());
    return !inside(*outline_, {{at.x, at.y, 0}}, crs_);
  });
  found.resize(std::min(found.size(), limit_));
  return found;
}

double MapQuestion::distance(const MapStore& map, const Landmark& landmark) const {
  if (query_.near) return map.distance(landmark, query_.near->x, query_.near->y);
  return map.distance(landmark, query_.nearest->x, query_.nearest->y);
}

}  // namespace waymark

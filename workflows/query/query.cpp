// SPDX-License-Identifier: Apache-2.0
#include "workflows/query/query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "exporters/vector/vector_format.hpp"
#include "workflows/parse_number.hpp"
#include "workflows/query/area_of_map.hpp"
#include "workflows/query/query_area.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

double check_not_negative(const std::string& what, double value) {
  if (!(value >= 0)) throw Error(ErrorCode::usage, what + " must be 0 or more, is " + std::to_string(value));
  return value;
}

double check_fraction(const std::string& what, double value) {
  check_number(what, value, "", {.help = "", .min = 0, .max = 1});
  return value;
}

/// Throws Error{usage} for metres given as degrees.
void check_degrees(const std::string& option, double x, double y, const Crs& crs) {
  if (crs.kind() != CrsKind::geographic || (std::abs(x) <= 540 && std::abs(y) <= 90)) return;
  throw Error(
      ErrorCode::usage,
      fmt::format("{} has the position {:g} {:g}, but coordinates are longitude and latitude in degrees ({})",
                  option, x, y, crs.id()),
      "", "e.g. 8.0 46.5; for metres name their CRS: --crs EPSG:...");
}

CrsTransform::XY in_map(const std::string& option, const std::vector<double>& point, const Crs& from,
                        const geodb::MapStore& map) {
  check_degrees(option, point[0], point[1], from);
  if (from.same_as(map.crs())) return {point[0], point[1]};
  const CrsTransform::XY at = CrsTransform(from, map.crs())(point[0], point[1]);
  if (!std::isfinite(at.x) || !std::isfinite(at.y))
    throw Error(ErrorCode::usage,
                fmt::format("{} has the position {:g} {:g}, which is nowhere in the map's CRS, {}", option,
                            point[0], point[1], map.crs().id()),
                "", "the coordinates are in " + from.id());
  return at;
}

}  // namespace

PreparedQuery::PreparedQuery(const QueryRequest& request, const geodb::MapStore& map)
    : crs_(request.crs.empty() ? map.crs() : Crs::from_text(request.crs)),
      limit_(static_cast<std::size_t>(check_not_negative("--limit", static_cast<double>(request.limit)))) {
  for (const std::string& type : request.types)
    static_cast<void>(map.count(type));  // throws for a type that the map lacks
  query_.types = request.types;
  query_.min_quality = check_fraction("--min-quality", request.min_quality);
  query_.min_confidence = check_fraction("--min-confidence", request.min_confidence);
  query_.largest_first = request.largest;
  if (!request.sensor.empty()) sensor_ = find_sensor(request.sensor, map.path().string());
  query_.sensor = sensor_.get();
  for (const std::string& text : request.min_features) {
    const auto [feature, value] = parse_feature_value("--min", text);
    query_.features.push_back({.feature = feature, .min_value = value});
  }
  for (const std::string& text : request.max_features) {
    const auto [feature, value] = parse_feature_value("--max", text);
    query_.features.push_back({.feature = feature, .max_value = value});
  }
  check_bounds();
  set_centre(request, map);
  set_box(request, map);
  if (!request.aoi.empty()) {
    MapArea area = area_of_map(request.aoi, map.path());
    inside_ = std::move(area.contains);
    if (!query_.box) query_.box = area.box;
  }
  if (!outline_ && !inside_) {
    query_.limit = request.limit;
  } else if (query_.nearest) {  // which of the nearest are inside is known only afterwards
    limit_ = std::min(limit_, static_cast<std::size_t>(query_.nearest->k));
    query_.nearest->k = map.count();
  }
}

void PreparedQuery::check_bounds() const {
  for (const auto& low : query_.features)
    for (const auto& high : query_.features)
      if (low.feature == high.feature && low.min_value > high.max_value)
        throw Error(ErrorCode::usage, fmt::format("--min {0}={1:g} is above --max {0}={2:g}", low.feature,
                                                  low.min_value, high.max_value));
}

void PreparedQuery::set_centre(const QueryRequest& request, const geodb::MapStore& map) {
  if (!request.near.empty()) {
    const auto centre = in_map("--near", request.near, crs_, map);
    query_.near = geodb::MapQuery::Near{centre.x, centre.y,
                                        Meters{check_not_negative("RADIUS of --near", request.near[2])}};
  }
  if (!request.nearest.empty()) {
    const auto centre = in_map("--nearest", request.nearest, crs_, map);
    const double count = check_not_negative("COUNT of --nearest", request.nearest[2]);
    if (count != std::floor(count))
      throw Error(ErrorCode::usage, fmt::format("COUNT of --nearest must be a whole number, is {:g}", count));
    query_.nearest = geodb::MapQuery::NearestK{centre.x, centre.y, static_cast<std::int64_t>(count)};
  }
}

void PreparedQuery::set_box(const QueryRequest& request, const geodb::MapStore& map) {
  if (request.bbox.empty()) return;
  check_degrees("--bbox", request.bbox[0], request.bbox[1], crs_);
  check_degrees("--bbox", request.bbox[2], request.bbox[3], crs_);
  const geodb::MapQuery::Box box{request.bbox[0], request.bbox[1], request.bbox[2], request.bbox[3]};
  if (box.min_y > box.max_y || (box.min_x > box.max_x && crs_.kind() != CrsKind::geographic))
    throw Error(ErrorCode::usage,
                "--bbox takes the lower left and the upper right corner: X0 <= X1, Y0 <= Y1");
  query_.box = box;
  if (crs_.same_as(map.crs())) return;
  outline_ = box;
  query_.box = covering_box(box, crs_, map.crs());
}

std::vector<Landmark> PreparedQuery::run(const geodb::MapStore& map) const {
  std::vector<Landmark> found = map.query(query_);
  if (!outline_ && !inside_) return found;
  const CrsTransform transform(map.crs(), crs_);
  std::erase_if(found, [&](const Landmark& landmark) {
    const double x = landmark.position.xyz.x(), y = landmark.position.xyz.y();
    if (inside_ && !inside_(x, y)) return true;
    if (!outline_) return false;
    const auto at = transform(x, y);
    return !inside(*outline_, {{at.x, at.y, 0}}, crs_);
  });
  found.resize(std::min(found.size(), limit_));
  return found;
}

std::string PreparedQuery::explain_bound(const geodb::MapStore& map,
                                         const geodb::MapQuery::FeatureRange& bound) const {
  const std::string& number = bound.feature;
  const auto range = map.range_of(number, query_.types);
  if (!range)
    return fmt::format("no landmark has a known '{}', so none meets a bound of it{}", number,
                       number == "quality" ? ": it was not assessed; bound 'confidence' instead" : "");
  const bool below = std::isfinite(bound.min_value);
  const std::string stored = sensor_ && number == "quality" ? ""
                                                            : fmt::format(": its values are {:.4g} to {:.4g}",
                                                                          range->first, range->second);
  return fmt::format("no landmark has '{}' of at {} {:g}{}", number, below ? "least" : "most",
                     below ? bound.min_value : bound.max_value, stored);
}

std::vector<std::string> PreparedQuery::explain_empty(const geodb::MapStore& map) const {
  if (limit_ == 0 || query_.limit == 0) return {};
  const auto meets = [&](geodb::MapQuery one) {
    one.types = query_.types, one.sensor = sensor_.get(), one.limit = 1;
    return !map.query(one).empty();
  };
  if (!meets({}))
    return {"the map has no landmark" + std::string(query_.types.empty() ? "" : " of these types")};
  std::vector<std::string> reasons;
  std::vector<geodb::MapQuery::FeatureRange> bounds = query_.features;
  if (query_.min_confidence > 0)
    bounds.push_back({.feature = "confidence", .min_value = query_.min_confidence});
  if (query_.min_quality > 0) bounds.push_back({.feature = "quality", .min_value = query_.min_quality});
  for (const auto& bound : bounds)
    if (!meets({.features = {bound}})) reasons.push_back(explain_bound(map, bound));
  if (query_.box || query_.near || inside_) {
    PreparedQuery place = *this;
    place.query_.features.clear();
    place.query_.min_confidence = place.query_.min_quality = 0;
    if (place.run(map).empty()) {
      const geodb::MapQuery::Box all = *map.extent();
      reasons.push_back(fmt::format(
          "no landmark lies there: those of the map cover x {:.10g} to {:.10g}, y {:.10g} to {:.10g} in {}",
          all.min_x, all.max_x, all.min_y, all.max_y, map.crs().id()));
    }
  }
  if (reasons.empty())
    reasons.emplace_back("no landmark meets all conditions, though some meet each of them");
  return reasons;
}

double PreparedQuery::distance(const geodb::MapStore& map, const Landmark& landmark) const {
  if (query_.near) return map.distance(landmark, query_.near->x, query_.near->y);
  return map.distance(landmark, query_.nearest->x, query_.nearest->y);
}

QueryResult query(const std::filesystem::path& file, const QueryRequest& request) {
  static const exporters::VectorFormat kGeoJson{.driver = "GeoJSON", .earth_only = true, .only_wgs84 = true};
  const geodb::MapStore map = geodb::MapStore::open(file);
  const PreparedQuery prepared(request, map);
  QueryResult result{
      .types = map.types(),
      .crs = request.wgs84 ? exporters::output_crs(kGeoJson, map.crs(), "", file) : prepared.crs(),
      .sensor = prepared.sensor()};
  const std::vector<Landmark> found = prepared.run(map);
  if (found.empty()) result.why_empty = prepared.explain_empty(map);
  if (prepared.from_point())
    for (const Landmark& landmark : found) result.distances[landmark.uid] = prepared.distance(map, landmark);
  result.landmarks = transform_landmarks(found, map.types(), map.crs(), result.crs);
  return result;
}

}  // namespace waymark::workflows

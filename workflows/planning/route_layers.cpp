// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route_layers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/atomic_file.hpp"
#include "geodb/write_map.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

using Json = nlohmann::ordered_json;
using Kind = AttributeSpec::Kind;

struct Ellipse {
  double major, minor, azimuth;  // metres; degrees clockwise from north
};

Ellipse ellipse_of(const planning::Symmetric3& p) {
  const double middle = (p.xx + p.yy) / 2, half = std::hypot((p.xx - p.yy) / 2, p.xy);
  const double angle = std::atan2(2 * p.xy, p.xx - p.yy) / 2;
  double azimuth = 90 - angle / kRadiansPerDegree;
  azimuth = std::fmod(azimuth + 360, 180);
  return {std::sqrt(middle + half), std::sqrt(std::max(0.0, middle - half)), azimuth};
}

std::string joined(const std::vector<std::string>& uids) {
  return fmt::format("{}", fmt::join(uids, " "));
}

/// Returns the line of a route; where it crosses the antimeridian, parts that end there.
std::vector<geodb::ShapePart> line_of(const PlannedRoute& route, bool is_geographic) {
  std::vector<geodb::ShapePart> parts(1);
  for (const RouteStation& station : route.stations) {
    auto& line = parts.back().outer;
    const bool crosses = is_geographic && !line.empty() && std::abs(station.at.x() - line.back().x()) > 180;
    if (!crosses) {
      line.push_back(station.at);
      continue;
    }
    const Eigen::Vector2d last = line.back();
    const double edge = std::copysign(180, last.x()), x = station.at.x() + 2 * edge;
    const double y = last.y() + (station.at.y() - last.y()) * (edge - last.x()) / (x - last.x());
    line.emplace_back(edge, y);
    parts.push_back({.outer = {Eigen::Vector2d(-edge, y), station.at}});
  }
  if (parts[0].outer.size() == 1) parts[0].outer.push_back(parts[0].outer[0]);
  return parts;
}

geodb::ShapeLayer route_layer(const RouteResult& result, bool is_geographic) {
  geodb::ShapeLayer layer{
      .name = "route",
      .summary = "Planned routes, the first one as requested, the others alternatives",
      .kind = geodb::ShapeKind::line,
      .columns = {{"length", "m", Kind::real, "Length in the plane"},
                  {"worst_sd", "m", Kind::real, "Largest sd of the position on the route"},
                  {"final_sd", "m", Kind::real, "Sd of the position at the goal"},
                  {"without_landmarks", "m", Kind::real, "Length without a landmark in sight"},
                  {"outside", "m", Kind::real, "Length with fewer landmarks than wanted"},
                  {"worlds_mean", "m", Kind::real, "Worst sd, mean over worlds"},
                  {"worlds_worst_tenth", "m", Kind::real, "Worst sd, in the worst tenth of worlds"}},
      .style = {.colour = "#1565c0", .width = 0.8}};
  for (const PlannedRoute& route : result.routes) {
    geodb::Shape shape;
    shape.parts = line_of(route, is_geographic);
    shape.values = {route.length,  route.worst_sd,    route.final_sd,          route.without_landmarks,
                    route.outside, route.worlds_mean, route.worlds_worst_tenth};
    layer.rows.push_back(std::move(shape));
  }
  return layer;
}

geodb::ShapeLayer station_layer(const RouteResult& result) {
  geodb::ShapeLayer layer{
      .name = "route_station",
      .summary = "Stations of the routes, with the ellipse of the position's error",
      .kind = geodb::ShapeKind::point,
      .columns = {{"route", "", Kind::integer, "Number of the route, from 1"},
                  {"distance", "m", Kind::real, "From the start"},
                  {"yaw", "rad", Kind::real, "Heading, from the x axis of the CRS towards its y axis"},
                  {"sd_major", "m", Kind::real, "Sd in the worst direction"},
                  {"sd_minor", "m", Kind::real, "Sd across it"},
                  {"azimuth", "deg", Kind::real, "Worst direction, clockwise from the y axis of the CRS"},
                  {"yaw_sd", "rad", Kind::real, "Sd of the heading"},
                  {"landmarks", "", Kind::integer, "Landmarks in sight"},
                  {"important", "", Kind::text, "Up to three uids that inform most"},
                  {"belly", "m", Kind::real, "Least clearance below the belly, a bound"},
                  {"tilt", "deg", Kind::real, "Largest tilt of the vehicle, a bound"}},
      .style = {.colour = "#1565c0"}};
  for (std::size_t i = 0; i < result.routes.size(); ++i)
    for (const RouteStation& s : result.routes[i].stations) {
      const Ellipse e = ellipse_of(s.covariance);
      geodb::Shape shape;
      shape.parts.push_back({.outer = {s.at}});
      shape.values = {static_cast<std::int64_t>(i + 1),
                      s.distance,
                      s.yaw,
                      e.major,
                      e.minor,
                      e.azimuth,
                      std::sqrt(s.covariance.tt),
                      std::int64_t{s.landmarks},
                      joined(s.important),
                      s.clearance ? AttributeValue{s.clearance->belly} : AttributeValue{},
                      s.clearance ? AttributeValue{s.clearance->tilt} : AttributeValue{}};
      layer.rows.push_back(std::move(shape));
    }
  return layer;
}

std::string as_csv(const PlannedRoute& route) {
  std::string text = "distance,x,y,yaw,var_x,var_y,cov_xy,var_yaw,sd,landmarks,important,belly,tilt\n";
  for (const RouteStation& s : route.stations)
    text +=
        fmt::format("{:.3f},{:.9g},{:.9g},{:.6f},{:.6g},{:.6g},{:.6g},{:.6g},{:.4f},{},{},{}\n", s.distance,
                    s.at.x(), s.at.y(), s.yaw, s.covariance.xx, s.covariance.yy, s.covariance.xy,
                    s.covariance.tt, s.sd, s.landmarks, joined(s.important),
                    s.clearance ? fmt::format("{:.3f},{:.2f}", s.clearance->belly, s.clearance->tilt) : ",");
  return text;
}

Json value_of(const AttributeValue& value) {
  return std::visit(
      [](const auto& v) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nullptr;
        else
          return v;
      },
      value);
}

Json geometry_of(const geodb::Shape& shape, bool is_line) {
  Json lines = Json::array();
  for (const geodb::ShapePart& part : shape.parts) {
    Json& line = lines.emplace_back(Json::array());
    for (const Eigen::Vector2d& at : part.outer) line.push_back({at.x(), at.y()});
  }
  if (!is_line) return {{"type", "Point"}, {"coordinates", lines[0][0]}};
  if (lines.size() == 1) return {{"type", "LineString"}, {"coordinates", lines[0]}};
  return {{"type", "MultiLineString"}, {"coordinates", lines}};
}

std::string as_geojson(const std::vector<geodb::ShapeLayer>& layers, const Crs& crs) {
  Json features = Json::array();
  for (const geodb::ShapeLayer& layer : layers)
    for (const geodb::Shape& shape : layer.rows) {
      Json feature{{"type", "Feature"},
                   {"geometry", geometry_of(shape, layer.kind == geodb::ShapeKind::line)},
                   {"properties", {{"layer", layer.name}}}};
      for (std::size_t i = 0; i < layer.columns.size(); ++i)
        feature["properties"][layer.columns[i].name] = value_of(shape.values[i]);
      features.push_back(feature);
    }
  return Json{{"type", "FeatureCollection"}, {"waymark_crs", crs.id()}, {"features", features}}.dump(1) +
         "\n";
}

}  // namespace

void write_routes(const RouteRequest& request, const Crs& crs, const RouteResult& result) {
  const std::string extension = std::filesystem::path(request.output).extension();
  if (extension == ".csv") return write_file(request.output, as_csv(result.routes.front()));
  const std::vector<geodb::ShapeLayer> layers{route_layer(result, crs.kind() == CrsKind::geographic),
                                              station_layer(result)};
  if (extension == ".geojson") return write_file(request.output, as_geojson(layers, crs));
  geodb::MapContents contents;
  contents.crs = crs;
  contents.layers = layers;
  geodb::write_map(request.output, contents);
}

}  // namespace waymark::workflows

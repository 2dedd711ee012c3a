// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/detections.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/error.hpp"
#include "core/principal_axes.hpp"
#include "landmarks/semantic_map.hpp"

namespace waymark::exporters {
namespace {

using Json = nlohmann::ordered_json;

/// Returns metres per pixel, right and down; `std::nullopt` if unknown.
std::optional<Eigen::Vector2d> pixel_size(const ImageDetections& found) {
  if (found.georeference) {
    const double metres = found.georeference->crs.metres_per_unit();
    return Eigen::Vector2d(found.georeference->dx * metres, -found.georeference->dy * metres);
  }
  if (found.gsd) return Eigen::Vector2d::Constant(found.gsd->value);
  return {};
}

/// An ellipse in metres: full axes, and the azimuth of the longer one, (-pi/2, pi/2].
struct GroundEllipse {
  double major = 0, minor = 0, azimuth = 0;
};

GroundEllipse on_ground(const PixelEllipse& outline, const Eigen::Vector2d& size) {
  const Eigen::Rotation2Dd turn(outline.angle);
  Eigen::Matrix2d axes = turn.toRotationMatrix() * Eigen::Vector2d(outline.major, outline.minor).asDiagonal();
  axes = size.asDiagonal() * axes;
  const PrincipalAxes ground = principal_axes(axes * axes.transpose());  // right, down = east, south
  double azimuth = ground.angle + std::numbers::pi / 2;
  if (azimuth > std::numbers::pi / 2) azimuth -= std::numbers::pi;
  return {std::sqrt(std::max(ground.major, 0.0)), std::sqrt(std::max(ground.minor, 0.0)), azimuth};
}

/// Returns metres per pixel in the direction of the light; the mean of both axes if it is unknown.
double metres_along_light(const ImageDetections& found, const Eigen::Vector2d& size) {
  if (!found.sun_angle) return std::sqrt(size.x() * size.y());
  return std::hypot(size.x() * std::cos(found.sun_angle->value), size.y() * std::sin(found.sun_angle->value));
}

Eigen::Vector2d map_position(const Georeference& place, const PixelEllipse& outline) {
  return {place.x(outline.x), place.y(outline.y)};
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}
std::string pixel(double value) {
  return fmt::format("{:.4f}", value);
}

/// Rounds to `steps` per unit, so that JSON shows no 0.30000000000000004.
double rounded(double value, double steps) {
  return std::round(value * steps) / steps;
}

/// Positions in the GeoJSON, and the name of their CRS.
class JsonPositions {
 public:
  explicit JsonPositions(const ImageDetections& found) : found_(found) {
    if (!found.georeference || found.georeference->crs.kind() == CrsKind::local) {
      crs_ = Crs::local();
      return;
    }
    const bool on_earth = found.georeference->crs.body().name == earth().name;
    const Crs degrees = on_earth ? Crs::from_text("EPSG:4326") : geographic_crs(found.georeference->crs);
    to_degrees_.emplace(found.georeference->crs, degrees);
    if (!on_earth) crs_ = degrees;
  }

  /// Adds a `crs` member if positions are not in WGS 84. RFC 7946 has no such member; GDAL reads it.
  void name_crs(Json& collection) const {
    if (!crs_) return;
    const std::string name = crs_->authority().empty()
                                 ? crs_->wkt2()
                                 : fmt::format("urn:ogc:def:crs:{}::{}", crs_->authority(), crs_->code());
    collection["crs"] = {{"type", "name"}, {"properties", {{"name", name}}}};
  }

  Json coordinates(const PixelEllipse& outline) const {
    if (!found_.georeference) return {rounded(outline.x, 1e4), rounded(outline.y, 1e4)};
    const Eigen::Vector2d at = map_position(*found_.georeference, outline);
    if (!to_degrees_) return {rounded(at.x(), 1e4), rounded(at.y(), 1e4)};
    const auto there = (*to_degrees_)(at.x(), at.y());
    return {rounded(there.x, 1e9), rounded(there.y, 1e9)};
  }

 private:
  const ImageDetections& found_;
  std::optional<CrsTransform> to_degrees_;
  std::optional<Crs> crs_;
};

Json value_or_null(double value, double steps) {
  return std::isfinite(value) ? Json(rounded(value, steps)) : Json();
}

Json properties(const ImageDetections& found, std::size_t index, const LandmarkType& type) {
  const Detection& one = found.detections[index];
  const PixelEllipse& o = one.outline;
  Json all{{"type", type.name},
           {"x", rounded(o.x, 1e4)},
           {"y", rounded(o.y, 1e4)},
           {"diameter", rounded(o.diameter(), 1e4)},
           {"major", rounded(o.major, 1e4)},
           {"minor", rounded(o.minor, 1e4)},
           {"angle", rounded(o.angle / kRadiansPerDegree, 1e3)},
           {"confidence", rounded(one.confidence, 1e6)}};
  if (!pixel_size(found)) return all;
  const FeatureSet features = features_of(found, index, type);
  for (std::size_t i = 0; i < features.size(); ++i)
    all[feature_column(type, type.features[i])] = value_or_null(features[i].value, 1e4);
  return all;
}

}  // namespace

FeatureSet level_ground_features(const ImageDetections& found, const Detection& one,
                                 const LandmarkType& type) {
  FeatureSet features(type.features.size());
  const auto size = pixel_size(found);
  if (!size) return features;
  const GroundEllipse ellipse = on_ground(one.outline, *size);
  const double diameter = std::sqrt(ellipse.major * ellipse.minor);
  const double scale = std::sqrt(size->x() * size->y());
  const double diameter_sd = one.diameter_sd * scale;
  const auto set = [&](const std::string& name, double value, double sd) {
    for (std::size_t i = 0; i < type.features.size(); ++i)
      if (type.features[i].name == name && std::isfinite(value)) features[i] = {value, sd * sd, 1};
  };
  set("radius", diameter / 2, diameter_sd / 2);
  set("crown_diameter", diameter, diameter_sd);
  set("major_axis", ellipse.major, diameter_sd);
  set("minor_axis", ellipse.minor, diameter_sd);
  const double flattening = ellipse.major > 0 ? (ellipse.major - ellipse.minor) / ellipse.major : 0;
  if (flattening > 0.02)  // a circle has no orientation
    set("orientation", ellipse.azimuth,
        std::min(std::numbers::pi / 4, diameter_sd / std::max(1e-9, ellipse.major - ellipse.minor)));
  if (one.shadow_reach && found.sun_elevation) {
    const double rise =
        std::tan(found.sun_elevation->value * kRadiansPerDegree) * metres_along_light(found, *size);
    set("height", one.shadow_reach->value * rise, one.shadow_reach->sd * rise);
  }
  return features;
}

FeatureSet features_of(const ImageDetections& found, std::size_t index, const LandmarkType& type) {
  if (found.features.empty()) return level_ground_features(found, found.detections[index], type);
  return found.features[index];
}

std::string feature_column(const LandmarkType& type, const FeatureSpec& feature) {
  for (const char* taken : {"x", "y", "diameter", "major", "minor", "angle", "confidence"})
    if (feature.name == taken) return type.name + "_" + feature.name;
  return feature.name;
}

std::string detections_to_csv(const ImageDetections& found, const LandmarkType& type) {
  const bool sized = pixel_size(found).has_value();
  std::string text = "x,y,diameter,major,minor,angle,confidence";
  if (sized)
    for (const FeatureSpec& feature : type.features) text += "," + feature_column(type, feature);
  if (found.georeference) text += ",map_x,map_y";
  text += '\n';
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    const Detection& one = found.detections[i];
    const PixelEllipse& o = one.outline;
    text += fmt::format("{},{},{},{},{},{:.3f},{:.6g}", pixel(o.x), pixel(o.y), pixel(o.diameter()),
                        pixel(o.major), pixel(o.minor), o.angle / kRadiansPerDegree, one.confidence);
    if (sized)
      for (const FeatureValue& feature : features_of(found, i, type))
        text += "," + (feature.known() ? cell(feature.value) : "");
    if (found.georeference) {
      const Eigen::Vector2d at = map_position(*found.georeference, o);
      text += fmt::format(",{:.4f},{:.4f}", at.x(), at.y());
    }
    text += '\n';
  }
  return text;
}

std::string detections_to_geojson(const ImageDetections& found, const LandmarkType& type) {
  const JsonPositions places(found);
  Json head{{"type", "FeatureCollection"}, {"name", type.name}};
  places.name_crs(head);
  std::string text = head.dump();
  text.pop_back();
  text += ",\"features\":[";
  const char* before = "\n";
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    const Detection& one = found.detections[i];
    const Json feature{{"type", "Feature"},
                       {"geometry", {{"type", "Point"}, {"coordinates", places.coordinates(one.outline)}}},
                       {"properties", properties(found, i, type)}};
    text += before + feature.dump();
    before = ",\n";
  }
  return text + "\n]}\n";
}

geodb::MapContents detections_to_map(const ImageDetections& found, const TypeRegistry& types) {
  ImageDetections sized = found;
  if (!pixel_size(found)) sized.gsd = Meters{1};
  const Eigen::Vector2d size = *pixel_size(sized);
  const Georeference place = found.georeference.value_or(
      Georeference{Crs::local(), 0, 0, sized.gsd ? sized.gsd->value : 1, sized.gsd ? -sized.gsd->value : -1});
  geodb::MapContents map;
  map.types = types;
  map.crs = place.crs;
  const LandmarkType& type = types[found.type];
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    const Detection& one = found.detections[i];
    Landmark landmark;
    landmark.type = found.type;
    landmark.position.xyz << map_position(place, one.outline), 0;
    const Eigen::Vector2d to_east_north(size.x(), -size.y());
    landmark.covariance.topLeftCorner<2, 2>() =
        to_east_north.asDiagonal() * one.covariance * to_east_north.asDiagonal();
    landmark.features = features_of(sized, i, type);
    landmark.attributes.resize(type.attributes.size());
    landmark.quality = {1, 1, std::vector<std::optional<double>>(type.features.size())};
    landmark.confidence = one.confidence;
    map.landmarks.push_back(std::move(landmark));
  }
  assign_uids(types, map.crs, map.landmarks);
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const Landmark& landmark = map.landmarks[i];
    const Detection& one = found.detections[i];
    Observation seen;
    seen.type = found.type;
    seen.landmark_uid = landmark.uid;
    seen.source = found.image;
    seen.pixel = Eigen::Vector2d(one.outline.x, one.outline.y);
    seen.position = landmark.position;
    seen.covariance = landmark.covariance;
    seen.confidence = std::clamp(one.confidence, 1e-6, 1.0);
    seen.features = landmark.features;
    map.observations.push_back(std::move(seen));
  }
  geodb::ImageRecord image;
  image.name = found.image;
  const double right = static_cast<double>(found.columns) - 0.5, low = static_cast<double>(found.rows) - 0.5;
  image.footprint = {{{place.x(-0.5), place.y(-0.5)},
                      {place.x(right), place.y(-0.5)},
                      {place.x(right), place.y(low)},
                      {place.x(-0.5), place.y(low)}}};
  const double metres = place.crs.kind() == CrsKind::local ? 1 : place.crs.metres_per_unit();
  image.camera_json = Json{{"model", "ortho"},
                           {"first_pixel", {place.x0 * metres, place.y0 * metres}},
                           {"step", {place.dx * metres, place.dy * metres}}}
                          .dump();
  image.sun_azimuth = found.sun_azimuth;
  image.sun_elevation = found.sun_elevation;
  image.gsd = Meters{std::sqrt(size.x() * size.y())};
  map.images.push_back(std::move(image));
  return map;
}

}  // namespace waymark::exporters

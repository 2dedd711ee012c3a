// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/move_map.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/json_text.hpp"

namespace waymark::workflows {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

/// Moves values of one map.
class MapMover {
 public:
  MapMover(const MapMove& move, double unit_from, double unit_to)
      : move_(move), from_(unit_from), to_(unit_to), scale_(std::exp(move.plane.log_scale)) {}

  Eigen::Vector2d plan(const Eigen::Vector2d& p) const { return (move_.plane * (p * from_)) / to_; }
  double height(double z) const { return scale_ * z + move_.lift; }

  void position(Eigen::Vector3d& xyz, Eigen::Matrix3d& covariance) const {
    xyz.head<2>() = plan(xyz.head<2>());
    xyz.z() = height(xyz.z());
    const Eigen::Vector3d arm = Eigen::Vector3d(xyz.x() * to_, xyz.y() * to_, xyz.z()) - move_.pivot;
    Eigen::Matrix<double, 3, 5> rows;
    rows << 1, 0, -arm.y(), arm.x(), 0,  //
        0, 1, arm.x(), arm.y(), 0,       //
        0, 0, 0, arm.z(), 1;
    const Eigen::Matrix3d common = rows * move_.covariance * rows.transpose();
    const Eigen::Matrix2d linear = move_.plane.linear(), flat = covariance.topLeftCorner<2, 2>();
    const Eigen::Vector2d mixed = covariance.topRightCorner<2, 1>();
    const double vertical = covariance(2, 2);  // by blocks: an unknown one is NaN
    covariance.topLeftCorner<2, 2>() = linear * flat * linear.transpose();
    covariance.topRightCorner<2, 1>() = scale_ * (linear * mixed);
    covariance.bottomLeftCorner<1, 2>() = covariance.topRightCorner<2, 1>().transpose();
    covariance(2, 2) = scale_ * scale_ * vertical;
    covariance += common;
  }

  void features(FeatureSet& features, const LandmarkType& type) const {
    for (std::size_t i = 0; i < std::min(features.size(), type.features.size()); ++i) {
      const FeatureSpec& spec = type.features[i];
      FeatureValue& f = features[i];
      if (is_angle(spec.scale)) {
        f.value = difference(f.value, move_.plane.yaw, spec.scale);
        continue;
      }
      const double factor = factor_of(spec.unit);
      const bool elevation = spec.scale == Scale::interval && spec.unit == "m";
      f.value = elevation ? height(f.value) : f.value * factor;
      f.variance = f.variance * factor * factor + (elevation ? move_.covariance(4, 4) : 0);
    }
  }

  void attributes(AttributeSet& values, const std::vector<AttributeSpec>& specs) const {
    for (std::size_t i = 0; i < std::min(values.size(), specs.size()); ++i) {
      double* value = std::get_if<double>(&values[i]);
      if (value == nullptr) continue;
      if (specs[i].name.ends_with("_x"))
        position_pair(values, specs, i);
      else if (specs[i].unit == "m" && specs[i].name.ends_with("elevation"))
        *value = height(*value);
      else
        *value *= factor_of(specs[i].unit);
    }
  }

  void image(geodb::ImageRecord& image) const {
    for (auto& ring : image.footprint)
      for (Eigen::Vector2d& corner : ring) corner = plan(corner);
    const double degrees = move_.plane.yaw * 180 / kHalfTurn;
    if (image.sun_azimuth) {
      const double azimuth = std::fmod(image.sun_azimuth->value - degrees, 360);
      image.sun_azimuth = Degrees{azimuth < 0 ? azimuth + 360 : azimuth};
    }
    if (image.gsd) image.gsd = Meters{image.gsd->value * scale_};
    image.camera_json = camera(image.camera_json);
  }

 private:
  double factor_of(const std::string& unit) const {
    if (unit == "m") return scale_;
    if (unit == "m2") return scale_ * scale_;
    return unit == "m3" ? scale_ * scale_ * scale_ : 1;
  }

  void position_pair(AttributeSet& values, const std::vector<AttributeSpec>& specs, std::size_t x) const {
    const std::string twin = specs[x].name.substr(0, specs[x].name.size() - 1) + "y";
    for (std::size_t y = 0; y < std::min(values.size(), specs.size()); ++y) {
      double *east = std::get_if<double>(&values[x]), *north = std::get_if<double>(&values[y]);
      if (specs[y].name != twin || east == nullptr || north == nullptr) continue;
      const Eigen::Vector2d there = plan({*east, *north});
      *east = there.x();
      *north = there.y();
    }
  }

  // An orthophoto that is turned has no grid of the new frame; it gets no camera.
  std::string camera(const std::string& text) const {
    nlohmann::json json = nlohmann::json::parse(json_or_empty(text), nullptr, false);
    if (!json.is_object() || !json.contains("centre") || !json.contains("grid_from_camera")) return "{}";
    const auto centre = json["centre"].get<std::vector<double>>();
    auto rows = json["grid_from_camera"].get<std::vector<std::vector<double>>>();
    if (centre.size() != 3 || rows.size() != 3) return "{}";
    const Eigen::Vector2d at = move_.plane * Eigen::Vector2d(centre[0], centre[1]);
    json["centre"] = {at.x(), at.y(), height(centre[2])};
    const double c = std::cos(move_.plane.yaw), s = std::sin(move_.plane.yaw);
    for (std::size_t k = 0; k < std::min(rows[0].size(), rows[1].size()); ++k)
      std::tie(rows[0][k], rows[1][k]) =
          std::pair(c * rows[0][k] - s * rows[1][k], s * rows[0][k] + c * rows[1][k]);
    json["grid_from_camera"] = rows;
    if (json.contains("motion")) {
      auto shift = json["motion"].at("shift").get<std::vector<double>>();
      if (shift.size() != 3) return "{}";
      std::tie(shift[0], shift[1]) = std::pair(c * shift[0] - s * shift[1], s * shift[0] + c * shift[1]);
      json["motion"]["shift"] = shift;
    }
    return json.dump();
  }

  MapMove move_;
  double from_, to_, scale_;
};

void move_layer(geodb::ShapeLayer& layer, const MapMover& mover) {
  for (geodb::Shape& shape : layer.rows) {
    for (geodb::ShapePart& part : shape.parts) {
      for (Eigen::Vector2d& p : part.outer) p = mover.plan(p);
      for (auto& hole : part.holes)
        for (Eigen::Vector2d& p : hole) p = mover.plan(p);
    }
    mover.attributes(shape.values, layer.columns);
  }
}

}  // namespace

double metres_of(const Crs& crs) {
  return crs.kind() == CrsKind::projected ? crs.metres_per_unit() : 1;
}

void move_map(geodb::MapContents& contents, const MapMove& move, const Crs& crs) {
  const MapMover mover(move, metres_of(contents.crs), metres_of(crs));
  const auto moved_landmark = [mover](Landmark& l, const LandmarkType& type) {
    mover.position(l.position.xyz, l.covariance);
    mover.features(l.features, type);
    mover.attributes(l.attributes, type.attributes);
  };
  const auto moved_observation = [mover](Observation& o, const LandmarkType& type) {
    mover.position(o.position.xyz, o.covariance);
    mover.features(o.features, type);
  };
  for (Landmark& l : contents.landmarks) moved_landmark(l, contents.types[l.type]);
  for (Observation& o : contents.observations) moved_observation(o, contents.types[o.type]);
  for (geodb::ImageRecord& image : contents.images) mover.image(image);
  for (geodb::ShapeLayer& layer : contents.layers) move_layer(layer, mover);
  const TypeRegistry types = contents.types;
  const auto landmarks = std::move(contents.parts.landmarks);
  contents.parts.landmarks = [landmarks, types, moved_landmark](std::size_t part) {
    auto moved = std::make_shared<std::vector<Landmark>>(*landmarks(part));
    for (Landmark& l : *moved) moved_landmark(l, types[l.type]);
    return std::shared_ptr<const std::vector<Landmark>>(moved);
  };
  for (auto* observations : {&contents.parts.evidence, &contents.parts.rejected}) {
    if (!*observations) continue;
    *observations = [read = std::move(*observations), types, moved_observation](std::size_t part) {
      auto moved = std::make_shared<std::vector<Observation>>(*read(part));
      for (Observation& o : *moved) moved_observation(o, types[o.type]);
      return std::shared_ptr<const std::vector<Observation>>(moved);
    };
  }
  contents.crs = crs;
}

}  // namespace waymark::workflows

// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/building_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "geo/outline_shapes.hpp"
#include "landmarks/semantic_map.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kDirectionSd = 0.02;  // rad: of a wall beside that of its ends
constexpr double kCornerSd = 0.05;     // rad: of the angles at a corner

double square(double v) {
  return v * v;
}

/// Converts positions of a survey to its CRS.
struct ToCrs {
  const Georeference& where;
  double unit = where.crs.metres_per_unit();
  Eigen::Vector2d operator()(const Eigen::Vector2d& metres) const {
    return {where.x0 + metres.x() / unit, where.y0 + metres.y() / unit};
  }
};

class Maker {
 public:
  Maker(const CanopySource& canopy, const TypeRegistry& types)
      : canopy_(canopy), types_(types), to_crs_{canopy.geometry().where} {}

  /// Begins a landmark at a position of the survey; `ground` may be NaN.
  Landmark& begin(const char* type, const Eigen::Vector2d& at, double ground, double confidence) {
    Landmark& landmark = made_.landmarks.emplace_back();
    landmark.type = types_.id(type);
    landmark.position.xyz << to_crs_(at), std::isnan(ground) ? 0 : ground;
    landmark.covariance(2, 2) = std::isnan(ground) ? std::nan("") : 0.25;
    landmark.confidence = confidence;
    landmark.quality.seen = landmark.quality.visible = 1;
    landmark.features.resize(types_[landmark.type].features.size());
    landmark.attributes.resize(types_[landmark.type].attributes.size());
    landmark.quality.feature_confidences.resize(landmark.features.size());
    return landmark;
  }

  void set(Landmark& landmark, const char* feature, double value, double sd) const {
    if (std::isnan(value)) return;
    const LandmarkType& type = types_[landmark.type];
    const std::size_t i = feature_index(type, feature);
    const FeatureSpec& spec = type.features[i];
    landmark.features[i] = {is_angle(spec.scale) ? difference(value, 0, spec.scale) : value, sd * sd, 1};
  }

  const ToCrs& to_crs() const { return to_crs_; }
  BuildingLandmarks& made() { return made_; }

  /// Gives uids, and makes the observations.
  BuildingLandmarks finish() {
    std::ranges::stable_sort(made_.landmarks, {}, [](const Landmark& l) {
      return std::tuple(l.type, l.position.xyz.x(), l.position.xyz.y());
    });
    const Georeference& where = canopy_.geometry().where;
    assign_uids(types_, where.crs, made_.landmarks);
    for (const Landmark& l : made_.landmarks) {
      Observation seen;
      seen.type = l.type, seen.landmark_uid = l.uid, seen.source = canopy_.name();
      seen.pixel = Eigen::Vector2d(where.column(l.position.xyz.x()), where.row(l.position.xyz.y()));
      seen.position = l.position, seen.covariance = l.covariance;
      seen.confidence = l.confidence, seen.features = l.features;
      made_.evidence.push_back(std::move(seen));
    }
    return std::move(made_);
  }

 private:
  const CanopySource& canopy_;
  const TypeRegistry& types_;
  ToCrs to_crs_;
  BuildingLandmarks made_;
};

std::vector<GeometryPart> part_of(const std::vector<Eigen::Vector2d>& ring, GeometryPart::Kind kind) {
  GeometryPart part{kind, {}};
  for (const Eigen::Vector2d& v : ring) part.vertices.emplace_back(v.x(), v.y(), 0);
  return {part};
}

/// Moves walls to their left, into the building, by `overhang`. Returns the ring itself if it does not allow
/// it.
std::vector<Eigen::Vector2d> moved_in(const std::vector<Eigen::Vector2d>& ring, double overhang) {
  std::vector<Eigen::Vector2d> moved;
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto inward = [&](std::size_t wall) {
      const Eigen::Vector2d run = (ring[(wall + 1) % n] - ring[wall]).normalized();
      return Eigen::Vector2d(-run.y(), run.x());
    };
    const Eigen::Vector2d a = inward((i + n - 1) % n), b = inward(i);
    const double sum = 1 + a.dot(b);
    moved.push_back(ring[i] +
                    (sum > 0.1 ? Eigen::Vector2d(overhang / sum * (a + b)) : Eigen::Vector2d::Zero()));
  }
  return ring_area(moved) * ring_area(ring) > 0 && is_simple(moved) ? moved : ring;
}

class Walls {
 public:
  Walls(Maker& maker, const DetectedBuilding& building, const WallRules& rules)
      : maker_(maker), building_(building), rules_(rules) {}

  void add(const RegularRing& ring, GeometryPart::Kind kind, const std::vector<double>& heights) const {
    const std::vector<Eigen::Vector2d> vertices =
        rules_.overhang > 0 ? moved_in(ring.vertices, rules_.overhang) : ring.vertices;
    const auto parts = part_of(vertices, kind);
    ShapeOptions options{.shape = ShapeOf::walls, .min_length = rules_.min_length};
    for (const DerivedShape& shape : derive_shapes(parts, options).shapes) {
      const std::size_t i = number(shape);
      const double across = variance(ring.sd[i]), length = shape.values.at("length");
      Landmark& wall = begin("wall", shape);
      wall.covariance.topLeftCorner<2, 2>() = across * Eigen::Matrix2d::Identity() +
                                              square(shape.along_sd) * shape.along * shape.along.transpose();
      maker_.set(wall, "direction", shape.values.at("direction"),
                 std::hypot(kDirectionSd, std::sqrt(12.0) * ring.sd[i] / length));
      maker_.set(wall, "length", length, std::hypot(ring.sd[i], std::sqrt(2.0) * rules_.overhang_sd));
      if (i < heights.size() && heights[i] > 0.1)
        maker_.set(wall, "height", heights[i], std::hypot(0.2, building_.height_sd));
    }
    options = {.shape = ShapeOf::corners};
    for (const DerivedShape& shape : derive_shapes(parts, options).shapes) {
      const std::size_t i = number(shape), before = (i + ring.sd.size() - 1) % ring.sd.size();
      Landmark& corner = begin("wall_corner", shape);
      const Eigen::Vector2d a = run(vertices, before), b = run(vertices, i);
      // The position is that of both lines: information adds up across each.
      const auto across = [&](const Eigen::Vector2d& along, double sd) {
        const Eigen::Vector2d normal(-along.y(), along.x());
        return Eigen::Matrix2d(normal * normal.transpose() / square(sd));
      };
      const Eigen::Matrix2d information = across(a, ring.sd[before]) + across(b, ring.sd[i]);
      corner.covariance.topLeftCorner<2, 2>() =
          information.inverse() + variance(0) * Eigen::Matrix2d::Identity();
      maker_.set(corner, "direction", shape.values.at("direction"), kCornerSd);
      maker_.set(corner, "opening_angle", shape.values.at("opening_angle"), kCornerSd);
    }
  }

 private:
  static std::size_t number(const DerivedShape& shape) {
    return static_cast<std::size_t>(std::stoi(shape.vertex)) - 1;
  }
  static Eigen::Vector2d run(const std::vector<Eigen::Vector2d>& ring, std::size_t i) {
    return (ring[(i + 1) % ring.size()] - ring[i]).normalized();
  }
  double variance(double sd) const {
    return square(sd) + square(rules_.overhang_sd) + square(rules_.survey_sd);
  }
  Landmark& begin(const char* type, const DerivedShape& shape) const {
    return maker_.begin(type, shape.at.head<2>(), building_.ground, building_.confidence);
  }

  Maker& maker_;
  const DetectedBuilding& building_;
  const WallRules& rules_;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace

BuildingLandmarks building_landmarks(std::span<const DetectedBuilding> buildings, const CanopySource& canopy,
                                     const TypeRegistry& types, const WallRules& rules) {
  Maker maker(canopy, types);
  std::vector<std::tuple<double, double, BuildingOutline>> outlines;
  for (const DetectedBuilding& b : buildings) {
    const double wall_sd = mean(b.outline.outer.sd);
    std::vector<GeometryPart> parts = part_of(b.outline.outer.vertices, GeometryPart::Kind::outline);
    for (const RegularRing& hole : b.outline.holes)
      parts.push_back(part_of(hole.vertices, GeometryPart::Kind::hole)[0]);
    const DerivedShapes whole = derive_shapes(parts, {.shape = ShapeOf::outline});
    if (whole.shapes.empty()) continue;
    const DerivedShape& shape = whole.shapes[0];
    Landmark& landmark = maker.begin("building", shape.at.head<2>(), b.ground, b.confidence);
    // The errors of opposite walls are independent: their middle has half the variance.
    landmark.covariance.topLeftCorner<2, 2>() =
        (square(wall_sd) / 2 + square(rules.survey_sd)) * Eigen::Matrix2d::Identity();
    maker.set(landmark, "height", b.height, b.height_sd);
    const double diameter = shape.values.at("diameter");
    maker.set(landmark, "diameter", diameter, wall_sd);
    if (const auto axis = shape.values.find("orientation"); axis != shape.values.end())
      maker.set(landmark, "orientation", axis->second, std::hypot(kDirectionSd, 2 * wall_sd / diameter));
    BuildingOutline footprint{.source = canopy.name(),
                              .roof = to_string(b.roof),
                              .outline = b.outline.kind == OutlineKind::regular ? "regular" : "cells",
                              .height = b.height,
                              .area = b.area,
                              .slope = b.slope,
                              .wall_sd = wall_sd,
                              .density = b.density,
                              .confidence = b.confidence};
    const auto add_ring = [&](const RegularRing& ring) {
      auto& into = footprint.rings.emplace_back();
      for (const Eigen::Vector2d& v : ring.vertices) into.push_back(maker.to_crs()(v));
    };
    add_ring(b.outline.outer);
    for (const RegularRing& hole : b.outline.holes) add_ring(hole);
    outlines.emplace_back(landmark.position.xyz.x(), landmark.position.xyz.y(), std::move(footprint));
    if (b.outline.kind != OutlineKind::regular) continue;
    const Walls walls(maker, b, rules);
    walls.add(b.outline.outer, GeometryPart::Kind::outline, b.wall_heights);
    for (const RegularRing& hole : b.outline.holes) walls.add(hole, GeometryPart::Kind::hole, {});
  }
  BuildingLandmarks made = maker.finish();
  // Buildings and outlines have the same order by position.
  std::ranges::stable_sort(outlines, {},
                           [](const auto& o) { return std::pair(std::get<0>(o), std::get<1>(o)); });
  const TypeId building = types.id("building");
  std::size_t next = 0;
  for (const Landmark& landmark : made.landmarks)
    if (landmark.type == building) {
      BuildingOutline& footprint = std::get<2>(outlines[next++]);
      footprint.uid = landmark.uid;
      made.footprints.push_back(std::move(footprint));
    }
  return made;
}

BuildingLandmarks pole_landmarks(std::span<const DetectedPole> poles, const CanopySource& canopy,
                                 const TypeRegistry& types, double survey_sd) {
  Maker maker(canopy, types);
  for (const DetectedPole& pole : poles) {
    Landmark& landmark = maker.begin("pole", pole.at, pole.ground, pole.confidence);
    landmark.covariance.topLeftCorner<2, 2>() =
        (square(pole.sd) + square(survey_sd)) * Eigen::Matrix2d::Identity();
    // The highest return lies on the top or below it.
    maker.set(landmark, "height", pole.height, 0.3);
  }
  return maker.finish();
}

}  // namespace waymark::pipeline

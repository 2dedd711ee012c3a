// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/line_pieces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "localization/identification/map_landmark.hpp"

namespace waymark::workflows {
namespace {

constexpr double kEndSd = 0.5;                          // m of the ends of a seen piece of a line
constexpr double kMinAngleVariance = 1e-8;              // rad^2
constexpr double kMaxDeviation = 0.1, kMaxTurn = 0.04;  // m, rad: of a piece of a line from it

/// The middle of the seen piece of a line in the frame of the sensor, and the unit vector along it.
struct LinePiece {
  Eigen::Vector2d middle, along;
};

LinePiece piece_of(const localization::SeenLandmark& s, const localization::LineFeatures& line) {
  const double angle = s.features.value[line.direction];
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle)), along(-normal.y(), normal.x());
  return {-*s.range * normal + (s.extent->from + s.extent->to) / 2 * along, along};
}

/// Pieces of one line, as its extent from a point on it. Long pieces count more: normals are weighted by the
/// inverse variance of their direction.
struct LineUnion {
  TypeId type;
  Eigen::Vector2d on, sum_of_normals;
  double from, to;
  std::vector<Observation*> pieces;

  Eigen::Vector2d normal() const { return sum_of_normals.normalized(); }
  Eigen::Vector2d along() const { return {-normal().y(), normal().x()}; }
  Eigen::Vector2d at(double s) const { return on + s * along(); }
};

/// Returns how far the middle of one line lies from another, m; `std::nullopt` if they are two lines.
std::optional<double> offset_on_one_line(const LineUnion& a, const LineUnion& b) {
  constexpr double kSameAngle = 0.15, kSameLine = 0.4, kSameGap = 1.5;  // rad, m, m
  if (a.type != b.type || !(a.normal().dot(b.normal()) > std::cos(kSameAngle))) return std::nullopt;
  const Eigen::Vector2d middle = b.at((b.from + b.to) / 2) - a.on;
  const double off = std::abs(a.normal().dot(middle)), s = a.along().dot(middle), half = (b.to - b.from) / 2;
  if (s - half > a.to + kSameGap || s + half < a.from - kSameGap || !(off < kSameLine)) return std::nullopt;
  return off;
}

void unite(LineUnion& a, const LineUnion& b) {
  const double s = a.along().dot(b.at((b.from + b.to) / 2) - a.on), half = (b.to - b.from) / 2;
  a.from = std::min(a.from, s - half), a.to = std::max(a.to, s + half);
  a.sum_of_normals += b.sum_of_normals;
  a.pieces.insert(a.pieces.end(), b.pieces.begin(), b.pieces.end());
}

/// Returns the line of an observation; `std::nullopt` if it is none.
std::optional<LineUnion> line_of(Observation& o, const TypeRegistry& types) {
  const auto line = localization::line_features(types[o.type]);
  if (!line || o.features.size() <= std::max(line->direction, line->length) ||
      !o.features[line->direction].known() || !o.features[line->length].known())
    return std::nullopt;
  const double azimuth = o.features[line->direction].value, half = o.features[line->length].value / 2;
  const Eigen::Vector2d normal(std::sin(azimuth), std::cos(azimuth));
  const double weight = 1 / std::max(o.features[line->direction].variance, kMinAngleVariance);
  return LineUnion{o.type, o.position.xyz.head<2>(), weight * normal, -half, half, {&o}};
}

/// A piece may close the gap between two lines: joins lines until none fits another.
void join_lines(std::vector<LineUnion>& lines) {
  for (std::size_t i = 0; i < lines.size();) {
    const auto other = std::find_if(lines.begin() + static_cast<std::ptrdiff_t>(i) + 1, lines.end(),
                                    [&](const LineUnion& l) { return offset_on_one_line(lines[i], l); });
    if (other == lines.end()) {
      ++i;
      continue;
    }
    unite(lines[i], *other);
    lines.erase(other);
    i = 0;  // the longer line may now reach one before it
  }
}

double variance_across(const Observation& o, const Eigen::Vector2d& normal) {
  return normal.dot(o.covariance.topLeftCorner<2, 2>() * normal);
}

/// Returns the mean distance of the pieces from the point `on`, across the line.
double mean_offset(const LineUnion& line) {
  const Eigen::Vector2d normal = line.normal();
  double sum = 0, weights = 0;
  for (const Observation* const o : line.pieces) {
    const double weight = 1 / std::max(variance_across(*o, normal), 1e-12);
    sum += weight * normal.dot(o->position.xyz.head<2>() - line.on);
    weights += weight;
  }
  return sum / weights;
}

/// Moves the pieces to the middle of their line. One that deviates a little more than it states, as the leaf
/// of a door in the wall does, gets the variance of its deviation: it stays an observation of the line, with
/// little weight. Returns the pieces that fit; others may be of another line beside it.
std::vector<Observation*> move_to_middle(const LineUnion& line, const localization::LineFeatures& of) {
  const Eigen::Vector2d normal = line.normal(), along = line.along();
  const double offset = mean_offset(line), azimuth = std::atan2(normal.x(), normal.y());
  std::vector<Observation*> fitting;
  for (Observation* const o : line.pieces) {
    const Eigen::Vector2d from_on = o->position.xyz.head<2>() - line.on;
    const double off = normal.dot(from_on) - offset,
                 turn = localization::wrap_angle(o->features[of.direction].value - azimuth);
    if (std::abs(off) < kMaxDeviation && std::abs(turn) < kMaxTurn) {
      o->covariance.topLeftCorner<2, 2>() +=
          std::max(0.0, off * off - variance_across(*o, normal)) * normal * normal.transpose();
      o->features[of.direction].variance = std::max(o->features[of.direction].variance, turn * turn);
      fitting.push_back(o);
    }
    o->position.xyz.head<2>() += ((line.from + line.to) / 2 - along.dot(from_on)) * along;
    o->features[of.length].value = line.to - line.from;
  }
  return fitting;
}

/// Joins two pieces of a line that one look sees, both moved to its middle. The better variances are kept,
/// since the pose of the look is common to both.
void join_piece(Observation& a, const Observation& b, const LineUnion& line, std::size_t direction) {
  const Eigen::Vector2d normal = line.normal();
  const auto fraction_of_b = [](double of_a, double of_b) { return of_a / std::max(of_a + of_b, 1e-300); };
  const double across_a = variance_across(a, normal), across_b = variance_across(b, normal);
  a.position.xyz.head<2>() +=
      fraction_of_b(across_a, across_b) * normal.dot((b.position.xyz - a.position.xyz).head<2>()) * normal;
  a.covariance.topLeftCorner<2, 2>() +=
      (std::min(across_a, across_b) - across_a) * normal * normal.transpose();
  auto& turned = a.features[direction];
  const auto& other = b.features[direction];
  turned.value =
      localization::wrap_angle(turned.value + fraction_of_b(turned.variance, other.variance) *
                                                  localization::wrap_angle(other.value - turned.value));
  turned.variance = std::min(turned.variance, other.variance);
  a.confidence = std::max(a.confidence, b.confidence);
}

}  // namespace

bool is_piece_of_line(const localization::SeenLandmark& s, const TypeRegistry& types) {
  if (!s.extent || !s.type || *s.type >= types.size()) return false;
  const auto line = localization::line_features(types[*s.type]);
  return line && s.features.known(line->direction);
}

Observation observation_of_line(const localization::SeenLandmark& s, const DriveLook& look,
                                const TypeRegistry& types, const localization::FeatureScales& scales,
                                const DriveMappingOptions& options) {
  const localization::LineFeatures line = *localization::line_features(types[*s.type]);
  const LinePiece piece = piece_of(s, line);
  const double length = s.extent->to - s.extent->from, middle = (s.extent->from + s.extent->to) / 2;
  const Eigen::Rotation2Dd turn(look.map_from_sensor.yaw);
  const Eigen::Vector2d along = turn * piece.along, normal(along.y(), -along.x());
  Observation o;
  o.type = *s.type;
  o.source = look.name;
  o.position.xyz << look.map_from_sensor.at() + turn * piece.middle, 0;
  o.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  o.covariance.topLeftCorner<2, 2>() =
      (s.range_sd * s.range_sd + middle * middle * options.yaw_sd * options.yaw_sd +
       options.position_sd * options.position_sd) *
          normal * normal.transpose() +
      length * length / 12 * along * along.transpose();
  o.confidence = s.confidence;
  const auto& features = types[o.type].features;
  const localization::KnownFeatures mapped = localization::features_in_map(
      scales, o.type, s.features, look.map_from_sensor.yaw, options.yaw_sd * options.yaw_sd);
  o.features.resize(features.size());
  for (std::size_t i = 0; i < std::min(features.size(), localization::kMaxFeatures); ++i)
    if (mapped.known(i)) o.features[i] = {mapped.value[i], mapped.variance[i], 1};
  o.features[line.length] = {length, kEndSd * kEndSd, 1};
  return o;
}

void unite_lines(std::vector<Observation>& observations, const TypeRegistry& types) {
  std::vector<LineUnion> lines;
  for (Observation& o : observations) {
    const auto piece = line_of(o, types);
    if (!piece) continue;
    LineUnion* best = nullptr;
    double nearest = std::numeric_limits<double>::infinity();
    for (LineUnion& line : lines)
      if (const auto off = offset_on_one_line(line, *piece); off && *off < nearest)
        best = &line, nearest = *off;
    if (best)
      unite(*best, *piece);
    else
      lines.push_back(*piece);
  }
  join_lines(lines);
  std::vector<char> is_joined(observations.size());
  for (const LineUnion& line : lines) {
    const localization::LineFeatures of = *localization::line_features(types[line.type]);
    std::map<std::string_view, Observation*> of_look;
    for (Observation* const o : move_to_middle(line, of)) {
      const auto [first, is_new] = of_look.try_emplace(o->source, o);
      if (is_new || o->source.empty()) continue;
      join_piece(*first->second, *o, line, of.direction);
      is_joined[static_cast<std::size_t>(o - observations.data())] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (!is_joined[i]) {
      if (kept != i) observations[kept] = std::move(observations[i]);
      ++kept;
    }
  observations.resize(kept);
}

void widen_line(Landmark& landmark, const LandmarkType& type) {
  const auto line = localization::line_features(type);
  if (!line || landmark.features.size() <= std::max(line->direction, line->length) ||
      !landmark.features[line->direction].known() || !landmark.features[line->length].known())
    return;
  const double azimuth = landmark.features[line->direction].value,
               length = landmark.features[line->length].value;
  const Eigen::Vector2d along(-std::cos(azimuth), std::sin(azimuth));
  landmark.covariance.topLeftCorner<2, 2>() += length * length / 12 * along * along.transpose();
}

}  // namespace waymark::workflows

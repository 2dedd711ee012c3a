// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/drive_landmarks.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "localization/identification/feature_distance.hpp"
#include "localization/identification/map_landmark.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

namespace waymark::workflows {
namespace {

using localization::SeenLandmark;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndSd = 0.5;        // m of the ends of a seen piece of a line
constexpr double kBeamSlack = 0.1;    // m by which a beam may end before a landmark that it shows
constexpr double kMinCosine = 0.3;    // of the angle between the open side and the sensor
constexpr double kMaxTilt = 0.1;      // rad, of a scanner whose beams stay at the height of an upright object
constexpr double kMinReturned = 0.6;  // of the beams through a place; what absorbs them would not be empty
/// Log odds against an object per look through its place. The other detections of what moved on are sure of
/// it, so one look does not decide.
constexpr double kSeenThrough = 4;

/// Returns the beam nearest to a bearing of the sensor; `std::nullopt` outside of the scan.
std::optional<std::size_t> beam_towards(const localization::LaserScan& scan, double bearing) {
  const double turn = std::remainder(bearing - scan.first_angle, 2 * std::numbers::pi);
  for (const double angle : {turn, turn + 2 * std::numbers::pi, turn - 2 * std::numbers::pi}) {
    const double beam = std::round(angle / scan.angle_step);
    if (beam >= 0 && beam < static_cast<double>(scan.ranges.size())) return static_cast<std::size_t>(beam);
  }
  return std::nullopt;
}

/// The middle of the seen piece of a line in the frame of the sensor, and the unit vector along it.
struct LinePiece {
  Eigen::Vector2d middle, along;
};

LinePiece piece_of(const SeenLandmark& s, const localization::LineFeatures& line) {
  const double angle = s.features.value[line.direction];
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle)), along(-normal.y(), normal.x());
  return {-*s.range * normal + (s.extent->from + s.extent->to) / 2 * along, along};
}

bool is_piece_of_line(const SeenLandmark& s, const TypeRegistry& types) {
  if (!s.extent || !s.type || *s.type >= types.size()) return false;
  const auto line = localization::line_features(types[*s.type]);
  return line && s.features.known(line->direction);
}

/// The sighting of a line as one of a point: the middle of its piece, whose covariance is long along it.
Observation observation_of_line(const SeenLandmark& s, const DriveLook& look, const TypeRegistry& types,
                                const localization::FeatureScales& scales,
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
  o.covariance.setConstant(kNotMeasured);
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

/// Pieces of one line, as its extent from a point on it.
struct LineUnion {
  TypeId type;
  Eigen::Vector2d on, sum_of_normals;
  double from, to;
  std::vector<Observation*> pieces;

  Eigen::Vector2d normal() const { return sum_of_normals.normalized(); }
  Eigen::Vector2d along() const { return {-normal().y(), normal().x()}; }
};

/// Looks see different pieces of a line. Moves each observation along its line to the middle of the union of
/// the pieces, and gives it the length of the union: they are then observations of one landmark.
void unite_lines(std::vector<Observation>& observations, const TypeRegistry& types) {
  constexpr double kSameAngle = 0.15, kSameLine = 0.4, kSameGap = 1.5;  // rad, m, m
  std::vector<LineUnion> unions;
  for (Observation& o : observations) {
    const auto line = localization::line_features(types[o.type]);
    if (!line || o.features.size() <= line->length || !o.features[line->direction].known() ||
        !o.features[line->length].known())
      continue;
    const double azimuth = o.features[line->direction].value, half = o.features[line->length].value / 2;
    const Eigen::Vector2d normal(std::sin(azimuth), std::cos(azimuth)), at = o.position.xyz.head<2>();
    LineUnion* best = nullptr;
    double nearest = kSameLine;
    for (LineUnion& u : unions) {
      if (u.type != o.type || !(u.normal().dot(normal) > std::cos(kSameAngle))) continue;
      const double off = std::abs(u.normal().dot(at - u.on)), s = u.along().dot(at - u.on);
      if (s - half > u.to + kSameGap || s + half < u.from - kSameGap || !(off < nearest)) continue;
      best = &u, nearest = off;
    }
    if (!best) best = &unions.emplace_back(LineUnion{o.type, at, Eigen::Vector2d::Zero(), -half, half, {}});
    const double s = best->sum_of_normals.isZero() ? 0 : best->along().dot(at - best->on);
    best->from = std::min(best->from, s - half), best->to = std::max(best->to, s + half);
    best->sum_of_normals += normal;
    best->pieces.push_back(&o);
  }
  for (const LineUnion& u : unions)
    for (Observation* const o : u.pieces) {
      const localization::LineFeatures line = *localization::line_features(types[u.type]);
      const Eigen::Vector2d at = o->position.xyz.head<2>();
      o->position.xyz.head<2>() += ((u.from + u.to) / 2 - u.along().dot(at - u.on)) * u.along();
      o->features[line.length].value = u.to - u.from;
    }
}

/// Restores what the mean of many pieces lost: the position of a line along itself is not known.
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

Observation observation_of(const SeenLandmark& s, const DriveLook& look, const TypeRegistry& types,
                           const localization::FeatureScales& scales, const DriveMappingOptions& options) {
  const localization::Pose2& sensor = look.map_from_sensor;
  const double along = sensor.yaw + *s.bearing;
  const Eigen::Rotation2Dd turn(along);
  const Eigen::Vector2d to = turn * Eigen::Vector2d(*s.range, 0);
  const double across = *s.range * *s.range * (s.bearing_sd * s.bearing_sd + options.yaw_sd * options.yaw_sd);
  Observation o;
  o.type = *s.type;
  o.source = look.name;
  o.position.xyz << sensor.at() + to, 0;
  o.covariance.setConstant(kNotMeasured);
  const Eigen::Matrix2d r = turn.toRotationMatrix();
  o.covariance.topLeftCorner<2, 2>() =
      r * Eigen::Vector2d(s.range_sd * s.range_sd, across).asDiagonal() * r.transpose() +
      options.position_sd * options.position_sd * Eigen::Matrix2d::Identity();
  o.confidence = s.confidence;
  const auto& features = types[o.type].features;
  const localization::KnownFeatures mapped =
      localization::features_in_map(scales, o.type, s.features, sensor.yaw, options.yaw_sd * options.yaw_sd);
  o.features.resize(features.size());
  for (std::size_t i = 0; i < std::min(features.size(), localization::kMaxFeatures); ++i) {
    const double value = mapped.value[i];
    if (mapped.known(i) && value >= features[i].min_value && value <= features[i].max_value)
      o.features[i] = {value, mapped.variance[i], 1};
  }
  return o;
}

double direction_of(const Landmark& landmark, const LandmarkType& type) {
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i)
    if (type.features[i].scale == Scale::direction && landmark.features[i].known())
      return landmark.features[i].value;
  return kNotMeasured;
}

/// Radius, m, of an object that stands as high as any beam; 0: unknown, or of another kind.
double upright_radius(const Landmark& landmark, const LandmarkType& type) {
  const auto body = pipeline::body_index(type);
  if (!body || (type.evidence != EvidenceModel::upright && type.evidence != EvidenceModel::canopy)) return 0;
  const FeatureValue& size = landmark.features[body->feature];
  return size.known() ? body->radius_per_value * size.value : 0;
}

void value_landmark(Landmark& landmark, std::span<const Observation* const> evidence,
                    std::span<const DriveLook> looks, const std::map<std::string_view, std::size_t>& by_name,
                    const LandmarkType& type, const DriveMappingOptions& options) {
  const Eigen::Vector2d at = landmark.position.xyz.head<2>();
  std::set<std::size_t> detected;
  std::vector<double> confidences;
  double farthest = 0;
  for (const Observation* o : evidence) {
    const std::size_t look = by_name.at(o->source);
    detected.insert(look);
    confidences.push_back(o->confidence);
    farthest = std::max(farthest, (looks[look].map_from_sensor.at() - at).norm());
  }
  const double direction = direction_of(landmark, type), radius = upright_radius(landmark, type);
  int visible = 0, through = 0;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const bool is_through = !detected.contains(i) && sees_through(looks[i], at, radius, options);
    through += is_through;
    visible += is_through || detected.contains(i) || covers(looks[i], at, direction, farthest);
  }
  landmark.quality.seen = static_cast<int>(detected.size());
  landmark.quality.visible = visible;
  landmark.quality.feature_confidences.assign(type.features.size(), std::nullopt);
  for (std::size_t f = 0; f < std::min(type.features.size(), landmark.features.size()); ++f)
    landmark.quality.feature_confidences[f] =
        spread_confidence(landmark.features[f], type.features[f].scale, type.features[f].reference);
  landmark.confidence =
      pipeline::existence_probability(confidences, visible - landmark.quality.seen, type.existence);
  if (through > 0) {
    const double odds = landmark.confidence / std::max(1 - landmark.confidence, 1e-12);
    landmark.confidence = 1 / (1 + std::exp(kSeenThrough * through) / odds);
  }
}

/// Moves a landmark or an observation from the map frame to the CRS.
template <class Placed>
void place_in_crs(Placed& one, const LocalFrame& frame, const TypeRegistry& types) {
  const Eigen::Vector2d at = one.position.xyz.template head<2>();
  one.position.xyz.template head<2>() =
      frame.crs_from_map_frame({{at.x(), at.y(), 0}}).xyz.template head<2>();
  rotate_axes(one, types[one.type].features, [&] { return grid_rotation(frame, at); });
}

/// The uids are then those of the positions in the CRS.
void place_in_crs(DriveLandmarks& made, const LocalFrame& frame, const TypeRegistry& types) {
  std::vector<std::string> uids_in_frame;
  for (Landmark& landmark : made.landmarks) {
    uids_in_frame.push_back(landmark.uid);
    place_in_crs(landmark, frame, types);
  }
  assign_uids(types, frame.crs(), made.landmarks);
  std::map<std::string_view, std::string_view> uids;
  for (std::size_t i = 0; i < made.landmarks.size(); ++i) uids[uids_in_frame[i]] = made.landmarks[i].uid;
  for (Observation& o : made.evidence) {
    place_in_crs(o, frame, types);
    if (const auto uid = uids.find(o.landmark_uid); uid != uids.end()) o.landmark_uid = uid->second;
  }
}

}  // namespace

std::vector<DriveLook> looks_of_drive(const localization::RobotLog& log,
                                      std::span<const localization::StampedPose> poses,
                                      const localization::ScanDetector& detect, const std::string& name,
                                      const DriveMappingOptions& options) {
  std::vector<DriveLook> looks;
  std::set<std::string> names;
  std::optional<localization::Pose2> last;
  double last_time = kNotMeasured;
  for (const localization::LogEvent& event : log.events) {
    const auto* scan = std::get_if<localization::LaserScan>(&event.what);
    const auto* seen = std::get_if<localization::SightingSet>(&event.what);
    if (!scan && !seen) continue;
    const auto robot = localization::pose_at(poses, event.t, options.max_gap);
    if (!robot) continue;
    const bool is_near = last && (robot->at() - last->at()).norm() < options.min_step &&
                         std::abs(localization::wrap_angle(robot->yaw - last->yaw)) < options.min_turn;
    if (is_near && event.t != last_time) continue;  // several sensors look at one time
    last = robot, last_time = event.t;
    DriveLook look{.name = fmt::format("{}@{:.3f}", name, event.t),
                   .map_from_sensor = {},
                   .seen = scan ? detect(*scan) : *seen,
                   .scan = scan ? *scan : localization::LaserScan{}};
    while (!names.insert(look.name).second) look.name += "+";
    look.map_from_sensor = *robot * (scan ? scan->robot_from_sensor : seen->robot_from_sensor);
    looks.push_back(std::move(look));
  }
  return looks;
}

bool covers(const DriveLook& look, const Eigen::Vector2d& at, double direction, double max_range) {
  const Eigen::Vector2d to = at - look.map_from_sensor.at();
  const double range = to.norm();
  if (!(range <= max_range && range > 0)) return false;
  const double north = std::numbers::pi / 2 - direction;  // direction in the frame of the map, from x to y
  if (std::isfinite(direction) &&
      -to.dot(Eigen::Vector2d(std::cos(north), std::sin(north))) < kMinCosine * range)
    return false;
  const double bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - look.map_from_sensor.yaw);
  const localization::LaserScan& scan = look.scan;
  if (scan.ranges.empty())  // within the bearings of the sightings
    return std::ranges::any_of(look.seen.sightings,
                               [&](const SeenLandmark& s) { return s.bearing && *s.bearing >= bearing; }) &&
           std::ranges::any_of(look.seen.sightings,
                               [&](const SeenLandmark& s) { return s.bearing && *s.bearing <= bearing; });
  const auto beam = beam_towards(scan, bearing);
  if (!beam) return false;
  const auto reached = static_cast<double>(scan.ranges[*beam]);
  return std::isfinite(reached) && reached > 0 && reached >= range - kBeamSlack;
}

bool sees_through(const DriveLook& look, const Eigen::Vector2d& at, double radius,
                  const DriveMappingOptions& options) {
  const localization::LaserScan& scan = look.scan;
  const Eigen::Vector2d to = at - look.map_from_sensor.at();
  const double range = to.norm(), step = std::abs(scan.angle_step);
  const double side = radius + 2 * std::hypot(options.position_sd, options.yaw_sd * range);
  // Four beams cross the object: none of its parts hides between two.
  if (!(radius > 0 && side < range / 2 && step > 0 && step * range <= radius / 2)) return false;
  if (scan.ranges.empty() || std::abs(scan.roll) > kMaxTilt || std::abs(scan.pitch) > kMaxTilt) return false;
  const double bearing = localization::wrap_angle(std::atan2(to.y(), to.x()) - look.map_from_sensor.yaw);
  const double half = std::asin(side / range);
  int beams = 0, behind = 0;
  for (double off = -half; off <= half; off += step) {
    const auto beam = beam_towards(scan, bearing + off);
    if (!beam) return false;
    ++beams;
    const auto reached = static_cast<double>(scan.ranges[*beam]);
    if (!(std::isfinite(reached) && reached > 0 && reached < scan.max_range)) continue;  // no return
    if (!(reached > range + radius + kBeamSlack)) return false;
    ++behind;
  }
  return behind >= kMinReturned * beams;
}

DriveLandmarks landmarks_of_looks(std::span<const DriveLook> looks, const TypeRegistry& types,
                                  const LocalFrame& frame, const DriveMappingOptions& options) {
  const localization::FeatureScales scales(types);
  std::vector<Observation> observations;
  std::map<std::string_view, std::size_t> by_name;
  DriveLandmarks made;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    by_name.emplace(looks[i].name, i);
    for (const SeenLandmark& s : looks[i].seen.sightings) {
      if (!s.is_valid()) continue;
      const bool is_typed = s.type && *s.type < types.size();
      const bool is_line = is_piece_of_line(s, types);
      made.unplaced += !s.has_position() && !is_line;
      made.untyped += s.has_position() && !is_typed;
      if (!(s.has_position() && is_typed) && !is_line) continue;
      if (*s.range <= options.max_range && is_line)
        observations.push_back(observation_of_line(s, looks[i], types, scales, options));
      else if (*s.range <= options.max_range)
        observations.push_back(observation_of(s, looks[i], types, scales, options));
      else
        ++made.too_far;
    }
  }
  unite_lines(observations, types);
  pipeline::MergeRules rules;
  rules.weights = pipeline::FeatureWeights::precision;
  rules.min_sd = options.position_sd;
  rules.association.max_distance = options.max_distance;
  rules.association.position_floor = options.association_sd;
  pipeline::MergedObservations merged =
      pipeline::merge_observations(std::move(observations), types, Crs::local(), rules);
  std::map<std::string_view, std::vector<const Observation*>> evidence;
  for (const Observation& o : merged.evidence)
    if (o.rejected.empty()) evidence[o.landmark_uid].push_back(&o);
  for (Landmark& landmark : merged.landmarks)
    value_landmark(landmark, evidence[landmark.uid], looks, by_name, types[landmark.type], options);
  made.landmarks = std::move(merged.landmarks);
  for (Landmark& landmark : made.landmarks) widen_line(landmark, types[landmark.type]);
  made.evidence = std::move(merged.evidence);
  made.improbable = pipeline::remove_improbable(made.landmarks, made.evidence, types);
  if (frame.crs().kind() != CrsKind::local) place_in_crs(made, frame, types);
  return made;
}

}  // namespace waymark::workflows

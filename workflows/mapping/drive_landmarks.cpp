// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/drive_landmarks.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"
#include "localization/identification/feature_distance.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "workflows/mapping/line_pieces.hpp"

namespace waymark::workflows {
namespace {

using localization::SeenLandmark;

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
/// Log odds against an object per look through its place. The other detections of what moved on are sure of
/// it, so one look does not decide.
constexpr double kSeenThrough = 4;

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

// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/map_landmark.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/rotate_axes.hpp"
#include "geo/axes_rotation.hpp"

namespace waymark::localization {
namespace {

// An unknown or unusable covariance must not make a landmark perfect or turn a filter's numbers into NaN.
Eigen::Matrix2d usable(const Eigen::Matrix3d& covariance) {
  constexpr double kUnknown = 1e-4;  // 1 cm: a map without covariances is taken as precise
  const Eigen::Matrix2d c = covariance.topLeftCorner<2, 2>();
  if (!c.allFinite() || !(c(0, 0) > 0) || !(c(1, 1) > 0)) return Eigen::Matrix2d::Identity() * kUnknown;
  const double limit = 0.999999 * std::sqrt(c(0, 0) * c(1, 1));  // a correlation beyond 1 is not one
  const double both = std::clamp((c(0, 1) + c(1, 0)) / 2, -limit, limit);
  Eigen::Matrix2d sound;
  sound << c(0, 0), both, both, c(1, 1);
  return sound;
}

/// Makes a line of a landmark whose direction and length are known; without them it remains a point.
void set_line(MapLandmark& landmark, const LineFeatures& line) {
  if (!landmark.features.known(line.direction) || !(landmark.features.value[line.length] > 0)) return;
  const double azimuth = landmark.features.value[line.direction];
  landmark.normal = {std::sin(azimuth), std::cos(azimuth)};
  landmark.normal_variance = landmark.features.variance[line.direction];
  landmark.half_length = landmark.features.value[line.length] / 2;
}

}  // namespace

std::optional<LineFeatures> line_features(const LandmarkType& type) {
  const auto index = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(type.features, name, &FeatureSpec::name) -
                                    type.features.begin());
  };
  const LineFeatures line{index("direction"), index("length")};
  if (!(std::max(line.direction, line.length) < std::min(type.features.size(), kMaxFeatures)) ||
      type.features[line.direction].scale != Scale::direction)
    return {};
  return line;
}

LandmarkKey landmark_key(std::string_view uid) {
  return named_seed(0, uid);
}

KnownFeatures known_features(const FeatureSet& features) {
  KnownFeatures known;
  for (std::size_t i = 0; i < std::min(features.size(), kMaxFeatures); ++i)
    if (features[i].known() && std::isfinite(features[i].value)) {
      known.value[i] = features[i].value;
      known.variance[i] = std::isfinite(features[i].variance) ? std::max(0.0, features[i].variance) : 0;
    }
  return known;
}

MapLandmark map_landmark(const Landmark& landmark, const LandmarkType& type, const LocalFrame& frame,
                         const SensorProfile* sensor) {
  MapLandmark robots;
  robots.key = landmark_key(landmark.uid);
  Point<MapCrs> ground = landmark.position;
  if (!std::isfinite(ground.xyz.z())) ground.xyz.z() = 0;
  robots.at = frame.map_frame_from_crs(ground).xyz.head<2>();
  const bool depends = depends_on_axes(landmark.covariance, landmark.features, type.features);
  const double rotation = depends ? -grid_rotation(frame, robots.at) : 0;
  robots.covariance = usable(rotate_axes(landmark.covariance, rotation));
  robots.type = landmark.type;
  const double quality = (sensor ? quality_for(*sensor, type, landmark) : quality_of(type, landmark))
                             .value_or(landmark.quality.visible > 0 ? kUnassessedQuality : 1);
  robots.paper_quality = std::clamp(quality, 1e-3, 1.0);
  robots.has_confidence = std::isfinite(landmark.confidence);
  robots.quality = robots.has_confidence ? std::clamp(landmark.confidence, 1e-3, 1.0) : robots.paper_quality;
  FeatureSet features = landmark.features;
  rotate_axes(features, type.features, rotation);
  robots.features = known_features(features);
  for (std::size_t i = 0; i < std::min(type.features.size(), landmark.features.size()); ++i)
    if (type.features[i].name == type.body.feature && landmark.features[i].value > 0)
      robots.diameter = 2 * type.body.radius_per_value * landmark.features[i].value;
  if (const auto line = line_features(type)) set_line(robots, *line);
  return robots;
}

std::vector<MapLandmark> to_map_landmarks(const SemanticMap& map, const SensorProfile* sensor) {
  std::vector<MapLandmark> all;
  all.reserve(map.size());
  for (const Landmark& landmark : map.landmarks())
    if (landmark.position.xyz.head<2>().allFinite())
      all.push_back(map_landmark(landmark, map.types()[landmark.type], map.frame(), sensor));
  return all;
}

}  // namespace waymark::localization

// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_signs.hpp"
#include "localization/detectors/detector_table.hpp"

namespace waymark::localization {

namespace {

constexpr double kSignConfidence = 0.8;  // boards and mirrors look like signs

struct SignType {
  TypeId type = 0;
  std::size_t facing = 0, height = 0;
};

SeenLandmark sighting_of_sign(const CloudSign& sign, const std::optional<SignType>& type) {
  const double range = sign.at.norm();
  const Eigen::Vector2d along = sign.at / range, across(-along.y(), along.x());
  SeenLandmark s;
  s.bearing = std::atan2(sign.at.y(), sign.at.x());
  s.bearing_sd = std::sqrt(across.dot(sign.covariance * across)) / range;
  s.range = range;
  s.range_sd = std::sqrt(along.dot(sign.covariance * along));
  s.confidence = kSignConfidence;
  if (!type) return s;
  s.type = type->type;
  s.features.value[type->facing] = std::atan2(sign.normal.y(), sign.normal.x());
  s.features.variance[type->facing] = sign.normal_variance;
  s.features.value[type->height] = sign.height;
  s.features.variance[type->height] = sign.height_sd * sign.height_sd;
  return s;
}

}  // namespace

void register_points_signs(DetectorTable& detectors);
void register_points_signs(DetectorTable& detectors) {
  detectors.add({.name = "signs",
                 .summary =
                     "Traffic signs in 3-D scans: strong returns of upright plates; without intensities "
                     "flat free plates",
                 .record = "points",
                 .types = {"traffic_sign"},
                 .make_points = [](const TypeRegistry& types) -> PointDetector {
                   std::optional<SignType> type;
                   if (const auto id = type_in_map(types, "traffic_sign"))
                     type = {*id, feature_index(types[*id], "facing"), feature_index(types[*id], "height")};
                   return [type](const PointCloud& cloud) {
                     SightingSet set{cloud.robot_from_sensor, {}};
                     for (const CloudSign& sign : find_signs(cloud))
                       if (sign.at.norm() > 0.5) set.sightings.push_back(sighting_of_sign(sign, type));
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

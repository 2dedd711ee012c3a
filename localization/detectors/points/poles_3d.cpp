// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_poles.hpp"
#include "localization/detectors/detector_table.hpp"

namespace waymark::localization {

namespace {

constexpr double kColumnConfidence = 0.8;  // people, and corners of vans, look like poles

SeenLandmark sighting_of_pole(const CloudPole& pole, std::optional<TypeId> type, std::size_t diameter) {
  const double range = pole.at.norm();
  const Eigen::Vector2d along = pole.at / range, across(-along.y(), along.x());
  SeenLandmark s;
  s.type = type;
  s.bearing = std::atan2(pole.at.y(), pole.at.x());
  s.bearing_sd = std::sqrt(across.dot(pole.covariance * across)) / range;
  s.range = range;
  s.range_sd = std::sqrt(along.dot(pole.covariance * along));
  s.confidence = kColumnConfidence;
  if (type) {
    s.features.value[diameter] = pole.diameter;
    s.features.variance[diameter] = pole.diameter_sd * pole.diameter_sd;
  }
  return s;
}

}  // namespace

void register_points_poles_3d(DetectorTable& detectors);
void register_points_poles_3d(DetectorTable& detectors) {
  detectors.add({.name = "poles_3d",
                 .summary = "Poles and stems up to 0.7 m wide in 3-D scans: tall, thin, nothing beside them",
                 .record = "points",
                 .types = {"pole"},
                 .make_points = [](const TypeRegistry& types) -> PointDetector {
                   const auto type = type_in_map(types, "pole");
                   const std::size_t diameter = type ? feature_index(types[*type], "diameter") : 0;
                   return [=](const PointCloud& cloud) {
                     SightingSet set{cloud.robot_from_sensor, {}};
                     for (const CloudPole& pole : find_poles(cloud))
                       if (pole.at.norm() > 0.5)
                         set.sightings.push_back(sighting_of_pole(pole, type, diameter));
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

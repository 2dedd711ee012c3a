// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/scan_segments.hpp"
#include "localization/detectors/wall_features.hpp"

namespace waymark::localization {

namespace {

// Assumed: furniture and people imitate corners and ends of walls.
constexpr double kCornerConfidence = 0.7, kEndConfidence = 0.7;

struct CornerType {
  std::optional<TypeId> type;
  std::size_t direction = 0, opening_angle = 0;
};
CornerType corner_type(const TypeRegistry& types) {
  CornerType found{.type = type_in_map(types, "wall_corner")};
  if (!found.type) return found;
  found.direction = feature_index(types[*found.type], "direction");
  found.opening_angle = feature_index(types[*found.type], "opening_angle");
  return found;
}
SeenLandmark corner_sighting(const LaserScan& scan, const WallCorner& corner, const CornerType& type) {
  SeenLandmark s = sighting_of_point(scan, corner.at, corner.covariance);
  s.type = type.type;
  s.confidence = kCornerConfidence;
  s.features.value[type.direction] = corner.direction;
  s.features.variance[type.direction] = corner.direction_variance;
  s.features.value[type.opening_angle] = corner.opening_angle;
  s.features.variance[type.opening_angle] = corner.opening_variance;
  return s;
}

struct EndType {
  std::optional<TypeId> type;
  std::size_t direction = 0, side = 0;
};
EndType end_type(const TypeRegistry& types) {
  EndType found{.type = type_in_map(types, "wall_end")};
  if (!found.type) return found;
  found.direction = feature_index(types[*found.type], "direction");
  found.side = feature_index(types[*found.type], "side");
  return found;
}
SeenLandmark end_sighting(const LaserScan& scan, const WallEnd& end, const EndType& type) {
  SeenLandmark s = sighting_of_point(scan, end.at, end.covariance);
  s.type = type.type;
  s.confidence = kEndConfidence;
  s.features.value[type.direction] = end.direction;
  s.features.variance[type.direction] = end.direction_variance;
  s.features.value[type.side] = end.side;
  s.features.variance[type.side] = 0.01;
  return s;
}

}  // namespace

void register_laser_walls(DetectorTable& detectors);
void register_laser_walls(DetectorTable& detectors) {
  detectors.add({.name = "walls",
                 .summary = "Corners of two walls, and ends of walls before a background",
                 .record = "laser",
                 .types = {"wall_corner", "wall_end"},
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   return [corner = corner_type(types), end = end_type(types)](const LaserScan& scan) {
                     const std::vector<WallLine> walls = find_wall_lines(scan);
                     SightingSet set{scan.robot_from_sensor, {}};
                     if (corner.type)
                       for (const WallCorner& c : find_wall_corners(walls))
                         set.sightings.push_back(corner_sighting(scan, c, corner));
                     if (end.type)
                       for (const WallEnd& e : find_wall_ends(scan, walls))
                         set.sightings.push_back(end_sighting(scan, e, end));
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

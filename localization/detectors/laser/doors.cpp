// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/scan_segments.hpp"
#include "localization/detectors/wall_features.hpp"

namespace waymark::localization {

namespace {

constexpr double kDoorConfidence = 0.7;  // as of the ends that it consists of

}  // namespace

void register_laser_doors(DetectorTable& detectors);
void register_laser_doors(DetectorTable& detectors) {
  detectors.add({.name = "doors",
                 .summary = "Openings of walls, from 0.7 to 1.2 m wide",
                 .record = "laser",
                 .types = {"door"},
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   const auto type = type_in_map(types, "door");
                   const std::size_t width = type ? feature_index(types[*type], "width") : 0;
                   const std::size_t orientation = type ? feature_index(types[*type], "orientation") : 0;
                   return [=](const LaserScan& scan) {
                     SightingSet set{scan.robot_from_sensor, {}};
                     for (const WallDoor& door : find_doors(scan, find_wall_lines(scan))) {
                       SeenLandmark s = sighting_of_point(scan, door.at, door.covariance);
                       s.type = type;
                       s.confidence = kDoorConfidence;
                       if (type) {
                         s.features.value[width] = door.width;
                         s.features.variance[width] = door.width_variance;
                         s.features.value[orientation] = door.orientation;
                         s.features.variance[orientation] = door.orientation_variance;
                       }
                       set.sightings.push_back(s);
                     }
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

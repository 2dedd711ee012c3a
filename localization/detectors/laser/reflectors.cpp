// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_reflectors.hpp"

#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {

namespace {

constexpr double kReflectorConfidence = 0.9;

}  // namespace

void register_laser_reflectors(DetectorTable& detectors);
void register_laser_reflectors(DetectorTable& detectors) {
  detectors.add(
      {.name = "reflectors",
       .summary = "Posts with reflecting tape, by the intensities of the scan; their identity is unknown",
       .record = "laser",
       .types = {"beacon"},
       .finds_single_objects = true,
       .make = [](const TypeRegistry& types) -> LaserDetector {
         const auto type = type_in_map(types, "beacon");
         const std::size_t diameter = type ? feature_index(types[*type], "diameter") : 0;
         return [=](const LaserScan& scan) {
           SightingSet set{scan.robot_from_sensor, {}};
           for (const Reflector& r : find_reflectors(scan)) {
             SeenLandmark s;
             s.type = type;
             const auto [range, bearing] = level_range_bearing(scan, r.range, r.bearing);
             s.range = range, s.range_sd = r.range_sd;
             s.bearing = wrap_angle(bearing), s.bearing_sd = r.bearing_sd;
             s.confidence = kReflectorConfidence;
             if (type) {
               s.features.value[diameter] = r.diameter;
               s.features.variance[diameter] = r.diameter_sd * r.diameter_sd;
             }
             set.sightings.push_back(s);
           }
           return set;
         };
       }});
}

}  // namespace waymark::localization

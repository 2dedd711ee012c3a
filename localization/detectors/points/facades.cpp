// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_facades.hpp"
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/line_sighting.hpp"

namespace waymark::localization {

namespace {

constexpr double kFacadeConfidence = 0.8;  // sides of trucks, and boards, look like facades

}  // namespace

void register_points_facades(DetectorTable& detectors);
void register_points_facades(DetectorTable& detectors) {
  detectors.add({.name = "facades",
                 .summary = "Facades and high walls in 3-D scans: vertical planes, known across themselves",
                 .record = "points",
                 .types = {"wall"},
                 .make_points = [](const TypeRegistry& types) -> PointDetector {
                   return [line = line_type(types, "wall")](const PointCloud& cloud) {
                     SightingSet set{cloud.robot_from_sensor, {}};
                     if (!line) return set;
                     for (const CloudFacade& f : find_facades(cloud))
                       set.sightings.push_back(sighting_of_line({.centre = f.centre,
                                                                 .normal = f.normal,
                                                                 .begin = f.begin,
                                                                 .end = f.end,
                                                                 .centre_variance = f.centre_variance,
                                                                 .angle_variance = f.angle_variance},
                                                                *line, kFacadeConfidence));
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

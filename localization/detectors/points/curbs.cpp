// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_curbs.hpp"
#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/line_sighting.hpp"

namespace waymark::localization {

namespace {

constexpr double kCurbConfidence = 0.8;
constexpr double kStepSd = 0.03;  // m: kerbs are lowered at drives

}  // namespace

void register_points_curbs(DetectorTable& detectors);
void register_points_curbs(DetectorTable& detectors) {
  detectors.add(
      {.name = "curbs",
       .summary = "Kerbs from 5 to 25 cm high in 3-D scans, from the lower side; known across themselves",
       .record = "points",
       .types = {"curb"},
       .make_points = [](const TypeRegistry& types) -> PointDetector {
         const auto line = line_type(types, "curb");
         const std::size_t height = line ? feature_index(types[line->type], "height") : 0;
         return [=](const PointCloud& cloud) {
           SightingSet set{cloud.robot_from_sensor, {}};
           if (!line) return set;
           for (const CloudCurb& c : find_curbs(cloud)) {
             SeenLandmark s = sighting_of_line({.centre = c.centre,
                                                .normal = c.normal,
                                                .begin = c.begin,
                                                .end = c.end,
                                                .centre_variance = c.centre_variance,
                                                .angle_variance = c.angle_variance},
                                               *line, kCurbConfidence);
             s.features.value[height] = c.step;
             s.features.variance[height] = kStepSd * kStepSd;
             set.sightings.push_back(s);
           }
           return set;
         };
       }});
}

}  // namespace waymark::localization

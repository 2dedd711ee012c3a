// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/wall_lines.hpp"

#include <algorithm>
#include <cmath>

#include "localization/detectors/detector_table.hpp"
#include "localization/detectors/line_sighting.hpp"

namespace waymark::localization {
namespace {

constexpr double kLineConfidence = 0.7;               // sides of cars and shelves look like walls
constexpr double kMinWall = 1;                        // m
constexpr std::size_t kMaxWalls = 6;                  // the longest of a scan; more exceed joint association
constexpr double kWallSd = 0.02, kWallTurnSd = 0.01;  // m, rad: of walls that are not perfectly straight

SeenLandmark sighting_of_wall(const WallLine& wall, const LineType& type) {
  // The scan runs to the left, so that the far end of a wall seen from its front is on the right.
  const bool leftwards = wall.along.dot(Eigen::Vector2d(-wall.normal.y(), wall.normal.x())) > 0;
  SeenLandmark seen = sighting_of_line({.centre = wall.centre,
                                        .normal = wall.normal,
                                        .begin = leftwards ? wall.begin : -wall.end,
                                        .end = leftwards ? wall.end : -wall.begin,
                                        .centre_variance = wall.centre_variance + kWallSd * kWallSd,
                                        .angle_variance = wall.angle_variance + kWallTurnSd * kWallTurnSd},
                                       type, kLineConfidence);
  // All deviations within the limits of a wall count as equally probable.
  seen.extent->deviation_sd = kMaxPieceOffset / std::sqrt(3.0);
  seen.extent->deviation_turn_sd = kMaxPieceTurn / std::sqrt(3.0);
  return seen;
}

}  // namespace

void register_laser_wall_lines(DetectorTable& detectors);
void register_laser_wall_lines(DetectorTable& detectors) {
  detectors.add({.name = "wall_lines",
                 .summary = "Straight pieces of walls of a metre and more, known across themselves",
                 .record = "laser",
                 .types = {"wall"},
                 .make = [](const TypeRegistry& types) -> LaserDetector {
                   return [line = line_type(types, "wall")](const LaserScan& scan) {
                     SightingSet set{scan.robot_from_sensor, {}};
                     if (!line) return set;
                     std::vector<WallLine> walls =
                         join_collinear(find_wall_lines(scan, {.min_length = kMinWall}));
                     if (walls.size() > kMaxWalls) walls.resize(kMaxWalls);
                     for (const WallLine& wall : walls)
                       set.sightings.push_back(sighting_of_wall(wall, *line));
                     return set;
                   };
                 }});
}

}  // namespace waymark::localization

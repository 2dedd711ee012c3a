// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <filesystem>

#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
namespace waymark::test {
using namespace localization;

/// Real robots with motion-capture truth; the data are not in the repository.
inline std::filesystem::path mrclam_folder() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/localization/mrclam/MRCLAM_Dataset6";
}

#define SKIP_WITHOUT_MRCLAM() \
  if (!std::filesystem::exists(mrclam_folder())) GTEST_SKIP() << mrclam_folder() << " is not on this machine"

struct MrclamRobots {
  TypeRegistry types;
  std::vector<MapLandmark> map;
  std::vector<RobotLog> logs;       // of robots 1 to 5
  std::vector<PoseEstimate> start;  // the truth, with the deviations of `waymark localize`
};

inline MrclamRobots read_mrclam() {
  MrclamRobots all;
  register_landmark_types(all.types);
  const TypeId beacon = all.types.id("beacon");
  const SemanticMap map(all.types, Crs::local(),
                        importers::import_mrclam_landmarks(mrclam_folder(), beacon, all.types[beacon]), {});
  all.map = to_map_landmarks(map);
  for (int robot = 1; robot <= 5; ++robot) {
    RobotLog& log = all.logs.emplace_back(importers::import_mrclam_log(mrclam_folder(), robot, all.types));
    convert_to_map_frame(log, map.frame());
    PoseEstimate& start = all.start.emplace_back();
    start.pose = *pose_at(log.truth, log.events.front().t, 5);
    start.covariance = Eigen::Vector3d(0.01, 0.01, 0.0025).asDiagonal();
  }
  return all;
}

}  // namespace waymark::test

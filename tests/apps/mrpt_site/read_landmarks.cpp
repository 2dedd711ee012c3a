// SPDX-License-Identifier: Apache-2.0
// Prints `ID x y z` of each landmark that MRPT finds in a configuration file.
// usage: read_landmarks FILE
#include <mrpt/config/CConfigFile.h>
#include <mrpt/maps/CLandmarksMap.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include <cstdio>

int main(int count, char** words) {
  if (count != 2) return 2;
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  definitions.loadFromConfigFile(mrpt::config::CConfigFile(words[1]), "MetricMap");
  const mrpt::maps::CMultiMetricMap maps(definitions);
  const auto map = maps.mapByClass<mrpt::maps::CLandmarksMap>();
  if (!map) return 1;
  for (const mrpt::maps::CLandmark& one : map->landmarks)
    std::printf("%lld %.4f %.4f %.4f\n", static_cast<long long>(one.ID), one.pose_mean.x, one.pose_mean.y,
                one.pose_mean.z);
}

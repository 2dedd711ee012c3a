// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/scan_landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"

namespace waymark::localization {
namespace {

bool makes_type_of(const DetectorSpec& detector, const TypeRegistry& types) {
  return std::ranges::any_of(detector.types, [&](const std::string& name) { return types.find(name); });
}

std::vector<const DetectorSpec*> detectors_for(const TypeRegistry& types) {
  std::optional<int> rank;
  for (const DetectorSpec& detector : laser_detectors())
    if (detector.single_object_rank && makes_type_of(detector, types))
      rank = std::min(rank.value_or(*detector.single_object_rank), *detector.single_object_rank);
  std::vector<const DetectorSpec*> chosen;
  for (const DetectorSpec& detector : laser_detectors())
    if (makes_type_of(detector, types) &&
        (!detector.single_object_rank || detector.single_object_rank == rank))
      chosen.push_back(&detector);
  if (chosen.empty()) chosen.push_back(laser_detectors().find("stems"));
  return chosen;
}

std::vector<const DetectorSpec*> named_detectors(std::string_view list) {
  std::vector<const DetectorSpec*> chosen;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    const std::string_view name = list.substr(from, comma - from);
    const DetectorSpec* const detector = laser_detectors().find(name);
    if (!detector)
      throw Error(ErrorCode::usage, fmt::format("there is no detector '{}' for laser scans", name),
                  fmt::format("--set scans={}", list),
                  fmt::format("known are auto, {}", fmt::join(laser_detectors().names(), ", ")));
    if (std::ranges::find(chosen, detector) == chosen.end()) chosen.push_back(detector);
    from = comma + 1;
  }
  return chosen;
}

}  // namespace

void ScanDetectionOptions::describe(OptionVisitor& option) {
  option("scans", find,
         {.help =
              fmt::format("Detectors of landmarks in laser scans, separated by commas: {}; auto: those whose "
                          "types the map has",
                          fmt::join(laser_detectors().names(), ", "))});
  option("scan_features", features, {.help = "Use the diameters, radii and angles measured in scans"});
}

const DetectorTable& laser_detectors() {
  static const DetectorTable table = [] {
    DetectorTable made;
    register_laser_detectors(made);
    return made;
  }();
  return table;
}

const DetectorTable& point_detectors() {
  static const DetectorTable table = [] {
    DetectorTable made;
    register_point_detectors(made);
    return made;
  }();
  return table;
}

const DetectorTable& scan_detectors() {
  static const DetectorTable table = [] {
    DetectorTable made;
    register_laser_detectors(made);
    register_point_detectors(made);
    return made;
  }();
  return table;
}

PointDetector make_point_detector(const TypeRegistry& types) {
  std::vector<PointDetector> detectors;
  for (const DetectorSpec& detector : point_detectors())
    if (makes_type_of(detector, types)) detectors.push_back(detector.make_points(types));
  return [detectors = std::move(detectors)](const PointCloud& cloud) {
    SightingSet all{cloud.robot_from_sensor, {}};
    for (const PointDetector& detect : detectors) {
      SightingSet some = detect(cloud);
      all.sightings.insert(all.sightings.end(), some.sightings.begin(), some.sightings.end());
    }
    return all;
  };
}

LaserDetector make_laser_detector(const TypeRegistry& types, const ScanDetectionOptions& options) {
  std::vector<LaserDetector> detectors;
  for (const DetectorSpec* detector :
       options.find == "auto" ? detectors_for(types) : named_detectors(options.find))
    detectors.push_back(detector->make(types));
  return [detectors = std::move(detectors), with_features = options.features](const LaserScan& scan) {
    SightingSet all{scan.robot_from_sensor, {}};
    for (const LaserDetector& detect : detectors) {
      SightingSet some = detect(scan);
      all.sightings.insert(all.sightings.end(), some.sightings.begin(), some.sightings.end());
    }
    if (!with_features)
      for (SeenLandmark& s : all.sightings) s.features = {};
    return all;
  };
}

}  // namespace waymark::localization

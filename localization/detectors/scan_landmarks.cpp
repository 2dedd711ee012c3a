// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/scan_landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "localization/detectors/merge_sightings.hpp"
#include "localization/line_of_sight.hpp"

namespace waymark::localization {
namespace {

struct DetectorTables {
  DetectorTable laser, points, all;
};

/// Returns the detectors of the program, which only grow.
DetectorTables& tables_of_detectors() {
  static DetectorTables tables = [] {
    DetectorTables made;
    register_laser_detectors(made.laser);
    register_point_detectors(made.points);
    register_laser_detectors(made.all);
    register_point_detectors(made.all);
    return made;
  }();
  return tables;
}

/// Types of a map: those of its tables, and those of them that have landmarks.
struct MapTypes {
  const TypeRegistry& listed;
  std::span<const TypeId> held;  ///< empty: all that are listed

  bool holds(TypeId type) const { return held.empty() || std::ranges::find(held, type) != held.end(); }
  bool holds(std::string_view name) const { return listed.find(name) && holds(listed.id(name)); }
};

bool makes_type_of(const DetectorSpec& detector, const MapTypes& types) {
  return std::ranges::any_of(detector.types, [&](const std::string& name) { return types.holds(name); });
}

/// Returns the detectors as one, whose sightings of types that the map does not hold are left out.
template <class Scan>
std::function<SightingSet(const Scan&)> detect_held(
    std::vector<std::function<SightingSet(const Scan&)>> detectors, const MapTypes& types) {
  std::vector<char> is_held(types.listed.size());
  for (TypeId type = 0; type < is_held.size(); ++type) is_held[type] = types.holds(type);
  return [detectors = std::move(detectors), is_held = std::move(is_held)](const Scan& scan) {
    SightingSet all{scan.robot_from_sensor, {}};
    for (const auto& detect : detectors)
      for (const SeenLandmark& s : detect(scan).sightings)
        if (!s.type || is_held.at(*s.type)) all.sightings.push_back(s);
    return all;
  };
}

/// Returns the detectors for `auto`: those of a type that the map holds, with those of single objects as one.
std::vector<LaserDetector> detectors_of_map(const TypeRegistry& types, const MapTypes& of_map) {
  std::vector<LaserDetector> all, single_objects;
  for (const DetectorSpec& detector : laser_detectors())
    if (makes_type_of(detector, of_map))
      (detector.finds_single_objects ? single_objects : all)
          .push_back(detect_held(std::vector{detector.make(types)}, of_map));
  if (!single_objects.empty())
    all.push_back(
        [detectors = std::move(single_objects), scales = FeatureScales(types)](const LaserScan& scan) {
          std::vector<SightingSet> sets;
          for (const LaserDetector& detect : detectors) sets.push_back(detect(scan));
          return merge_sightings(sets, scales);
        });
  return all;
}

LaserDetector stems_of_no_type() {
  return laser_detectors().find("stems")->make({});
}

/// Returns whether the map holds types of no other detector than that of reflectors, which needs intensities.
bool only_reflectors(const MapTypes& of_map) {
  return std::ranges::all_of(laser_detectors(), [&](const DetectorSpec& detector) {
    return detector.name == "reflectors" || !makes_type_of(detector, of_map);
  });
}

/// Returns the detectors of a list of names, separated by commas, each once. Throws `unknown(name)`.
template <class Unknown>
std::vector<const DetectorSpec*> named_detectors(const DetectorTable& table, std::string_view list,
                                                 const Unknown& unknown) {
  std::vector<const DetectorSpec*> chosen;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    const std::string_view name = list.substr(from, comma - from);
    const DetectorSpec* const detector = table.find(name);
    if (!detector) throw unknown(name);
    if (std::ranges::find(chosen, detector) == chosen.end()) chosen.push_back(detector);
    from = comma + 1;
  }
  return chosen;
}

}  // namespace

void ScanDetectionOptions::describe(OptionVisitor& option) {
  option("scans", find,
         {.help = fmt::format(
              "Detectors of landmarks in laser scans, separated by commas: {}; auto: those whose "
              "types have landmarks in the map; without a map walls if they fill the scans, else rocks",
              fmt::join(laser_detectors().names(), ", "))});
  option("scan_features", features, {.help = "Use the diameters, radii and angles measured in scans"});
}

const DetectorTable& laser_detectors() {
  return tables_of_detectors().laser;
}

const DetectorTable& point_detectors() {
  return tables_of_detectors().points;
}

const DetectorTable& scan_detectors() {
  return tables_of_detectors().all;
}

void add_scan_detector(const DetectorSpec& detector) {
  tables_of_detectors().all.add(detector);
  (detector.record == "laser" ? tables_of_detectors().laser : tables_of_detectors().points).add(detector);
}

PointDetector make_point_detector(const TypeRegistry& types, std::span<const TypeId> held,
                                  std::span<const std::string> names) {
  const MapTypes of_map{types, held};
  for (const std::string& name : names)
    if (!point_detectors().find(name))
      throw Error(ErrorCode::usage, fmt::format("there is no detector '{}' for 3-D scans", name), "",
                  fmt::format("known are {}", fmt::join(point_detectors().names(), ", ")));
  std::vector<PointDetector> detectors;
  for (const DetectorSpec& detector : point_detectors())
    if (makes_type_of(detector, of_map) &&
        (names.empty() || std::ranges::find(names, detector.name) != names.end()))
      detectors.push_back(detector.make_points(types));
  return detect_held(std::move(detectors), of_map);
}

NamedDetectors name_scan_detectors(std::string_view list, std::string_view option) {
  if (list == "auto") return {.laser = {"auto"}, .points = {}};
  NamedDetectors named;
  for (const DetectorSpec* detector : named_detectors(scan_detectors(), list, [&](std::string_view name) {
         return Error(ErrorCode::usage, fmt::format("there is no detector '{}' for scans", name),
                      fmt::format("{} {}", option, list),
                      fmt::format("known are auto, {}", fmt::join(scan_detectors().names(), ", ")));
       }))
    (detector->record == "laser" ? named.laser : named.points).push_back(detector->name);
  return named;
}

LaserDetector make_laser_detector(const TypeRegistry& types, const ScanDetectionOptions& options,
                                  std::span<const TypeId> held) {
  const bool by_map = options.find == "auto";
  const MapTypes wanted{types, by_map ? held : std::span<const TypeId>()};
  std::vector<LaserDetector> detectors;
  if (by_map)
    detectors = detectors_of_map(types, wanted);
  else
    for (const DetectorSpec* detector :
         named_detectors(laser_detectors(), options.find, [&](std::string_view name) {
           return Error(ErrorCode::usage, fmt::format("there is no detector '{}' for laser scans", name),
                        fmt::format("--set scans={}", options.find),
                        fmt::format("known are auto, {}", fmt::join(laser_detectors().names(), ", ")));
         }))
      detectors.push_back(detector->make(types));
  if (detectors.empty()) detectors.push_back(stems_of_no_type());
  const LaserDetector without_intensities = by_map && only_reflectors(wanted) ? stems_of_no_type() : nullptr;
  return [detect = detect_held(std::move(detectors), wanted), without_intensities,
          with_features = options.features](const LaserScan& scan) {
    SightingSet all =
        without_intensities && scan.intensities.empty() ? without_intensities(scan) : detect(scan);
    if (scan.roll == 0 && scan.pitch == 0)
      all.ranges =
          std::make_shared<const RangeProfile>(RangeProfile{scan.first_angle, scan.angle_step, scan.ranges});
    if (!with_features)
      for (SeenLandmark& s : all.sightings) {
        s.features = {};
        for (PossibleType& possible : s.possible_types) possible.features = {};
      }
    return all;
  };
}

}  // namespace waymark::localization

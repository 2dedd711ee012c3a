// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "localization/detectors/detector_table.hpp"
namespace waymark::localization {

/// Options of landmark detection in laser scans.
struct ScanDetectionOptions {
  /// Names of detectors, separated by commas. `auto`: those whose types have landmarks in the map; `stems`
  /// without a type if there are none.
  std::string find = "auto";
  bool features = true;  ///< give diameters, radii and angles to the sightings

  void describe(OptionVisitor& option);
};

/// Returns all detectors for laser scans.
const DetectorTable& laser_detectors();

/// Returns all detectors for the points of 3-D scanners.
const DetectorTable& point_detectors();
/// Returns the detectors for both.
const DetectorTable& scan_detectors();

/// Adds a detector of a plug-in after the built-in ones. Nothing may use detectors in another thread
/// meanwhile. Throws std::logic_error if the name is taken.
void add_scan_detector(const DetectorSpec& detector);

/// Returns the detectors for 3-D scans of the types that a map holds, as one. `types` are those of its
/// tables, `held` those of its landmarks; empty: all of `types`. `names`: of the detectors to use; empty:
/// all. Throws Error{usage} for an unknown name.
PointDetector make_point_detector(const TypeRegistry& types, std::span<const TypeId> held = {},
                                  std::span<const std::string> names = {});

/// Detectors that a list names, by the records that they read.
struct NamedDetectors {
  std::vector<std::string> laser, points;
};

/// Returns the detectors of a list of names, separated by commas; of `auto` that name for laser scans. Throws
/// Error{usage} for an unknown name; `option`: that gave the list, for the message.
NamedDetectors name_scan_detectors(std::string_view list, std::string_view option);

/// Returns the detectors that the options name, for the types of a map, as one. `auto` detects only types
/// that the map holds, as above. Throws Error{usage} for an unknown name.
LaserDetector make_laser_detector(const TypeRegistry& types, const ScanDetectionOptions& options,
                                  std::span<const TypeId> held = {});

}  // namespace waymark::localization

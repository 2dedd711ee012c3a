// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "pipeline/engine/registry.hpp"
#include "workflows/detection/image_detector.hpp"
namespace waymark::apps {

/// A stage, landmark type, sensor profile, detector or vehicle in the four forms of `--format`.
struct ReferenceEntry {
  std::string name, summary;
  std::string text, json, schema, markdown;
};

std::vector<ReferenceEntry> registry_reference(const pipeline::Registry& stages);
std::vector<ReferenceEntry> registry_reference(const TypeRegistry& types);
std::vector<ReferenceEntry> registry_reference(const SensorRegistry& sensors, const TypeRegistry& types);
std::vector<ReferenceEntry> registry_reference(const localization::DetectorTable& detectors);
/// Returns the detectors in images, each named image_ and its name: scans have detectors of the same names.
std::vector<ReferenceEntry> registry_reference(const workflows::ImageDetectorTable& detectors);
/// Returns the built-in vehicles.
std::vector<ReferenceEntry> vehicle_reference();

/// Arguments of `waymark stages`, `types`, `sensors`, `detectors` and `vehicles`.
struct ReferenceRequest {
  std::string name;  ///< empty: all
  std::string format = "text";
};
std::vector<Argument> reference_arguments(ReferenceRequest& what, std::vector<std::string> names);

/// Prints one entry, or all: a list as text, an object by name as json and schema. Throws Error{usage} with
/// the nearest name if there is no such `kind`.
void print_reference(std::span<const ReferenceEntry> all, const std::string& kind,
                     const ReferenceRequest& what);

}  // namespace waymark::apps

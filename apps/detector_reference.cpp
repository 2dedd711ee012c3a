// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/registry_reference.hpp"
#include "core/options/option_table.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;
using localization::DetectorSpec;

/// When `auto` uses the detector.
std::string selection(const DetectorSpec& detector) {
  const std::string of_types = "if the map holds one of these types";
  if (!detector.finds_single_objects) return of_types;
  return of_types + "; an object that other such detectors find, too, is one sighting";
}

std::string as_text(const DetectorSpec& detector) {
  return fmt::format(
      "{}: {}\n\nReads       {} records of a log\nMakes       {}\nauto        {}\nSetting     scans={}\n",
      detector.name, detector.summary, detector.record, fmt::join(detector.types, ", "), selection(detector),
      detector.name);
}

std::string as_markdown(const DetectorSpec& detector) {
  return fmt::format(
      "# {}\n\n{}.\n\n| | |\n|---|---|\n| reads | `{}` records of a log |\n| makes | {} |\n| `scans=auto` "
      "uses "
      "it | {} |\n",
      detector.name, detector.summary, detector.record, fmt::join(detector.types, ", "), selection(detector));
}

std::string as_json(const DetectorSpec& detector) {
  Json object{{"name", detector.name},
              {"summary", detector.summary},
              {"record", detector.record},
              {"types", detector.types}};
  object["finds_single_objects"] = detector.finds_single_objects;
  return object.dump(2);
}

/// Of the settings of `localize` and `map` that choose this detector.
std::string as_schema(const DetectorSpec& detector) {
  localization::ScanDetectionOptions options;
  Json properties =
      Json::parse(option_schemas(option_table([&](OptionVisitor& option) { options.describe(option); })));
  for (auto& [name, property] : properties.items())
    if (property.contains("default") && property["default"] == options.find)
      property["default"] = detector.name;
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", detector.name},
              {"description", detector.summary},
              {"type", "object"},
              {"properties", properties}}
      .dump(2);
}

}  // namespace

std::vector<ReferenceEntry> registry_reference(const localization::DetectorTable& detectors) {
  std::vector<ReferenceEntry> all;
  for (const DetectorSpec& detector : detectors)
    all.push_back({detector.name, detector.summary, as_text(detector), as_json(detector), as_schema(detector),
                   as_markdown(detector)});
  return all;
}

}  // namespace waymark::apps
